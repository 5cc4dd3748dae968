#pragma once

#include "march/neighbour_index.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Does a surface in R^3 bend round less than two thirds of a cell somewhere along a curve (3 x m) on it: ways past
/// such places are marched wrongly. Two sheets back to back do not count. `neighbours`: of these cells.
[[nodiscard]] bool bends_sharply(const SurfaceCells& cells, const NeighbourIndex<3>& neighbours, const PointsIn& curve);

}  // namespace taut::detail
