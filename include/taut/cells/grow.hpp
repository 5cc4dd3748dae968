#pragma once

#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Decides whether the surface may cross cells: the one test that Algorithms I and II share.
class CrossingTest;

/// Algorithm II of the paper: cells that hold a seed, and all cells the surface crosses that are connected to them.
/// Lazy: `LazyCells` grows only where it is asked for neighbours.
[[nodiscard]] CellGrid grow(const Surface& surface, const PointsIn& seeds, double size, const Context& context = {});

}  // namespace taut
