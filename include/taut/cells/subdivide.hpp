#pragma once

#include "taut/cells/cell_grid.hpp"
#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct SubdivideOptions {
  /// sigma, the cell size wanted, model units.
  double size = 0;
  /// Where to look; unset = surface.box(), or find_box(surface).
  std::optional<Box> box;
};

/// Algorithm I of the paper: halve the cells of the box that the surface may cross until they are no larger than `size`.
/// With interval bounds no crossed cell is ever lost. ... (document the conservative test without bounds)
/// Cells wholly outside the domain are dropped. Throws EmptySurface, OutOfMemory, InvalidArgument, Cancelled.
[[nodiscard]] CellGrid subdivide(const Surface& surface, const SubdivideOptions& options, const Context& context = {});

/// A box that holds the whole surface when it is bounded (proved by interval bounds outside it, within `reach`), else
/// a box around `near` (points of interest, may be d x 0). Throws EmptySurface when nothing is found.
[[nodiscard]] Box find_box(const Surface& surface, const PointsIn& near, const Context& context = {});

}  // namespace taut
