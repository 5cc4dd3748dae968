#pragma once

#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::paper {

/// Points spread over a surface, each as far as can be from those before it (Gonzalez 1985, with geodesic distances as
/// by Peyre and Cohen).
struct FarthestPoints {
  Points points;               ///< d x n, in the order they were chosen
  Vector distance;             ///< of every cell from the nearest of them, model units; infinity = not reached
  std::vector<Index> nearest;  ///< by cell: the nearest of them, -1 = not reached
  std::vector<double> cover;   ///< after each: the largest distance left, model units
};

/// Chooses cells' surface points one by one, starting from `first` (d, on the surface), by marched distances.
/// Throws what `march` throws.
[[nodiscard]] FarthestPoints farthest_points(const Surface& surface, SurfaceCells& cells, const VectorIn& first,
                                             Index count, const Context& context = {});

}  // namespace taut::paper
