#pragma once

#include <optional>

#include "taut/cells/cell_counts.hpp"
#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct GrowOptions {
  /// sigma, the cell size wanted, model units, > 0.
  double size = 0;
  /// Where cell 0 begins, d; unset = lattice_origin(middle of the seeds, size).
  std::optional<Vector> origin = std::nullopt;
  /// Where to count the work; null = nowhere.
  CellCounts* counts = nullptr;
  /// With that many crossed cells, growth stops after the front at hand; 0 = never.
  Index most_cells = 0;
};

/// Algorithm II of the paper (sec. 3.1): the cells that hold a seed and are crossed (CrossingTest), and all crossed
/// cells connected to them, found front by front over the 2 d neighbours across faces (the paper's Figure 1). Faces
/// suffice: where the surface passes from cell to cell through an edge or a corner, all closed cells around that edge
/// or corner are crossed, and they are connected across faces. So on a connected surface the cells are those of
/// `subdivide` on the same lattice; cells kept only by overestimating bounds can differ, and none of them holds a
/// surface point.
///
/// `seeds`: d x n, n >= 1, surface points (samples; one is enough). Seeds beside the surface are projected first; those
/// that do not reach it are left out. The cells stand in Morton order; threads do not change them. Cost: each cell and
/// its neighbours are tested once, so O(d N) tests and hash look-ups for N cells, instead of the O(d N^2) that the
/// paper's Appendix I allows for. An unbounded surface without box or domain ends in OutOfMemory. Throws EmptySurface
/// when no seed's cell is crossed, InvalidArgument, OutOfMemory, Cancelled.
[[nodiscard]] CellGrid grow(const Surface& surface, const PointsIn& seeds, const GrowOptions& options,
                            const Context& context = {});

[[nodiscard]] inline CellGrid grow(const Surface& surface, const PointsIn& seeds, double size,
                                   const Context& context = {}) {
  return grow(surface, seeds, GrowOptions{.size = size}, context);
}

}  // namespace taut
