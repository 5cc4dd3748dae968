#include "distance_matrix.hpp"

#include <limits>

namespace taut::paper {

Eigen::MatrixXd distance_matrix(PathSolver& solver, const PointsIn& points) {
  const Index n = points.cols();
  Points from(points.rows(), n * (n - 1) / 2);
  Points to = from;
  Index pair = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j, ++pair) {
      from.col(pair) = points.col(i);
      to.col(pair) = points.col(j);
    }
  }
  const std::vector<PathResult> paths = solver.solve_pairs(from, to);
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(n, n);
  pair = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j, ++pair) {
      const PathResult& path = paths[static_cast<std::size_t>(pair)];
      const bool ok = path.status == Status::ok;
      distances(i, j) = distances(j, i) = ok ? path.length : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return distances;
}

}  // namespace taut::paper
