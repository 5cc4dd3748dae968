#pragma once

#include <vector>

#include "taut/query/path.hpp"

namespace taut {

/// A path through several points in order. The PathResult part is the whole: lengths, errors and seconds are sums,
/// residuals and cells the largest, `unique` and `locally_shortest` hold when they hold for every leg, `tied` and
/// `doubts` when they do for one, `points` run
/// through all legs without repeating the joints. It has the status and message of its worst leg, and no length and
/// points when a leg has none. `grid_path`, `candidates` and the directions at the ends are left to the legs.
struct ViaResult : PathResult {
  std::vector<PathResult> legs;  ///< n - 1, each a shortest path
};

/// The shortest path through column 0, 1, ..., n - 1 of `points` (d x n, n >= 2), each projected onto the surface as by
/// PathSolver::solve. Where every leg is globally shortest, so is the whole among the paths through these points.
/// Throws InvalidArgument for a wrong shape, and what PathSolver::solve throws, its message led by the leg's number.
[[nodiscard]] ViaResult path_through(PathSolver& solver, const PointsIn& points);

}  // namespace taut
