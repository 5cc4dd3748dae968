#include "surface/rbf/off_surface.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace taut::detail {
namespace {

/// Radius of the largest ball that touches sample i with its centre along `direction` and holds no other sample, if
/// below `limit`. At its centre the others are just as near as sample i.
double free_distance(const Points& samples, const KdTree& tree, Index i, const Vector& direction, double limit,
                     std::vector<Neighbour>& found) {
  double reach = limit;
  tree.within(samples.col(i).data(), 2 * limit, found);
  for (const Neighbour& q : found) {
    if (q.index == i) continue;
    const double along = direction.dot(samples.col(q.index) - samples.col(i));
    if (along > 0) reach = std::min(reach, q.squared_distance / (2 * along));
  }
  return reach;
}

}  // namespace

Constraints off_surface_constraints(const Points& samples, const Points& normals, const KdTree& tree, double offset,
                                    bool both_sides) {
  const Index n = samples.cols();
  // Half-way to the ball's centre the sample is the nearest by a clear margin.
  constexpr double kMargin = 0.5;
  constexpr double kLeast = 0.05;
  Constraints constraints{Points(samples.rows(), 3 * n), Vector(3 * n), {}};
  std::vector<Neighbour> found;
  Index count = 0;
  const auto add = [&](Index sample, double distance) {
    constraints.at.col(count) = samples.col(sample) + distance * normals.col(sample);
    constraints.value(count) = distance;
    constraints.sample.push_back(sample);
    ++count;
  };
  for (Index i = 0; i < n; ++i) {
    add(i, 0);
    bool placed = false;
    for (const double side : {1.0, -1.0}) {
      if (placed && !both_sides) break;
      const double limit = offset / kMargin;
      const double e = std::min(offset, kMargin * free_distance(samples, tree, i, side * normals.col(i), limit, found));
      if (e < kLeast * offset) continue;
      add(i, side * e);
      placed = true;
    }
  }
  constraints.at.conservativeResize(Eigen::NoChange, count);
  constraints.value.conservativeResize(count);
  return constraints;
}

}  // namespace taut::detail
