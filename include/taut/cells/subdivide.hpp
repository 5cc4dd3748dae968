#pragma once

#include <optional>

#include "taut/cells/cell_counts.hpp"
#include "taut/cells/cell_grid.hpp"
#include "taut/cells/find_box.hpp"
#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct SubdivideOptions {
  /// sigma, the cell size wanted, model units, > 0.
  double size = 0;
  /// Where to look; unset = find_box(surface, {}). Cells that do not meet it are dropped.
  std::optional<Box> box = std::nullopt;
  /// Where cell 0 begins, d; unset = lattice_origin(middle of the box, size).
  std::optional<Vector> origin = std::nullopt;
  /// Where to count the work; null = nowhere.
  CellCounts* counts = nullptr;
};

/// Algorithm I of the paper (sec. 3.1): halve the cells of the box that the surface may cross (CrossingTest) until they
/// have the size wanted. With interval bounds no crossed cell is ever lost, and cells wholly outside the domain are
/// dropped; without them the search starts from cells of 1/32 of the box (1/8 above d = 4), and what is finer may be
/// missed. The cells stand in Morton order. Threads do not change them. Cost O(2^d N) tests for N cells, as the paper's
/// Appendix I says; memory some 22 bytes a cell (d = 3), at most 80 while it runs. Throws EmptySurface,
/// InvalidArgument (also above d = 12), Cancelled, and OutOfMemory, the latter at once where the coarse cells already
/// show that the limit will be passed by far.
[[nodiscard]] CellGrid subdivide(const Surface& surface, const SubdivideOptions& options, const Context& context = {});

}  // namespace taut
