#pragma once

#include "taut/query/path.hpp"

namespace taut::paper {

/// Geodesic distances between all pairs of points (d x n): n x n, symmetric, 0 on the diagonal; NaN where a pair has no
/// answer. Throws what PathSolver::solve_pairs throws.
[[nodiscard]] Eigen::MatrixXd distance_matrix(PathSolver& solver, const PointsIn& points);

}  // namespace taut::paper
