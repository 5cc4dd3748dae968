#pragma once

#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Points spread over a surface, each as far as can be from those before it (Gonzalez 1985, with geodesic distances as
/// by Peyre and Cohen). No two are nearer to each other than the last `cover`, and every cell is at most that far from
/// one of them.
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

struct FarthestPointsOptions {
  GridMethod grid = GridMethod::automatic;
  /// Cell size h, model units; 0 = chosen, so fine that there are some dozen cells for each point, as far as the levels
  /// of refinement go.
  double cell = 0;
  Points seeds = {};  ///< as PathOptions::seeds
};

/// The same on cells of its own, in up to 6 dimensions (where the formula has edges: on the vertices of its mesh): at
/// most as many points as there are cells that a march from `first` (d, projected onto the surface; empty: the point of
/// any cell) reaches. Throws as PathSolver::solve, and InvalidArgument unless count >= 1.
[[nodiscard]] FarthestPoints farthest_points(const Surface& surface, const VectorIn& first, Index count,
                                             const FarthestPointsOptions& options = {}, const Context& context = {});

}  // namespace taut
