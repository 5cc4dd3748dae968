// Radii of curvature along a polyline by the vector triangle of the paper's Figure 2: the change of the unit tangent at
// a node over the mean of its two intervals. An interval takes the mean of its ends; the first and last node, which
// have one interval only, their neighbour's. Second order where intervals are even or nearly so.
#include "curve/osculating_circles.hpp"

namespace taut::detail {

Vector interval_lengths(const PointsIn& nodes) {
  const Index m = nodes.cols() - 1;
  return (nodes.rightCols(m) - nodes.leftCols(m)).colwise().norm().transpose();
}

Vector interval_curvatures(const PointsIn& nodes) {
  const Index m = nodes.cols() - 1;
  if (m < 2) return Vector::Zero(m);
  Vector at_node(m + 1);
  Vector last = nodes.col(1) - nodes.col(0);
  for (Index i = 1; i < m; ++i) {
    const Vector next = nodes.col(i + 1) - nodes.col(i);
    at_node(i) = 2 * (next.normalized() - last.normalized()).norm() / (next.norm() + last.norm());
    last = next;
  }
  at_node(0) = at_node(1);
  at_node(m) = at_node(m - 1);
  return (at_node.head(m) + at_node.tail(m)) / 2;
}

}  // namespace taut::detail
