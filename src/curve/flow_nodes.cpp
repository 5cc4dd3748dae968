// F and its Jacobian J (k x d) at all nodes in one visit, and what the flow needs of them there: J^T = n R with n (d x
// k) orthonormal, the step -J^+ F = -n R^-T F to the surface, and multipliers R^-1 n^T v. k = 1 has them by division;
// more equations by Householder reflections. A rank is judged by |R_jj| against the largest gradient along the curve,
// so that the scale of F plays no part.
#include "curve/flow_nodes.hpp"
#include "core/linear_algebra.hpp"

#include <algorithm>
#include <cmath>

namespace taut::detail {

void FlowNodes::evaluate(Evaluator& evaluator, Points points) {
  const Index n = points.cols();
  const Index d = dim_;
  const Index k = codim_;
  points_ = std::move(points);
  value_.resize(k, n);
  jacobian_.resize(d * k, n);
  normals_.resize(d * k, n);
  triangle_.resize(k * k, n);
  correction_.resize(d, n);
  evaluator.evaluate({.n = n, .x = points_.data(), .value = value_.data(), .jacobian = jacobian_.data()});

  // Typical size of each gradient along the curve: what "small" is measured against, whatever the scale of F.
  Vector typical = Vector::Zero(k);
  for (Index i = 0; i < n; ++i) typical = typical.cwiseMax(gradients(i).colwise().norm().transpose());
  rank_margin_ = 1;
  for (Index i = 0; i < n; ++i) {
    auto normal = Eigen::Map<Eigen::MatrixXd>(normals_.data() + i * d * k, d, k);
    auto triangle = Eigen::Map<Eigen::MatrixXd>(triangle_.data() + i * k * k, k, k);
    if (k == 1) {
      const double size = gradients(i).norm();
      triangle(0, 0) = size;
      normal = gradients(i) / size;
      correction_.col(i) = normal * (-value_(0, i) / size);
      rank_margin_ = std::min(rank_margin_, size / typical(0));
    } else {
      const ThinQr qr = thin_qr(gradients(i));
      triangle = qr.r;
      normal = qr.q;
      const Vector w = triangle.triangularView<Eigen::Upper>().transpose().solve(value_.col(i));
      correction_.col(i) = -(normal * w);
      for (Index j = 0; j < k; ++j) rank_margin_ = std::min(rank_margin_, std::abs(triangle(j, j)) / typical(j));
    }
    if (!correction_.col(i).allFinite() || !normal.allFinite()) rank_margin_ = 0;
  }
  if (!std::isfinite(rank_margin_)) rank_margin_ = 0;
}

void FlowNodes::multipliers(Index i, const VectorIn& v, Eigen::Ref<Vector> lambda) const {
  const auto triangle = Eigen::Map<const Eigen::MatrixXd>(triangle_.data() + i * codim_ * codim_, codim_, codim_);
  lambda.noalias() = normals(i).transpose() * v;
  triangle.triangularView<Eigen::Upper>().solveInPlace(lambda);
}

Points FlowNodes::corrected() const {
  Points moved = points_;
  const Index inner = size() - 2;
  moved.middleCols(1, inner) += correction_.middleCols(1, inner);
  return moved;
}

Repose measure_repose(const FlowNodes& nodes, const PointsIn& points, const VectorIn& widths) {
  Repose repose;
  Vector last = points.col(1) - points.col(0);
  double last_interval = last.norm();
  for (Index i = 1; i + 1 < points.cols(); ++i) {
    const Vector next = points.col(i + 1) - points.col(i);
    const double next_interval = next.norm();
    const double mean = 0.5 * (next_interval + last_interval);
    const auto normal = nodes.normals(i);
    const auto tangential = [&](Vector v) -> Vector { return v - normal * (normal.transpose() * v); };
    // The bisector of both edges, tangential to the surface: the direction of the curve at the node.
    const Vector along = tangential(next / next_interval + last / last_interval).normalized();
    const Vector curvature = tangential(next / next_interval - last / last_interval) / mean;  // (3), Figure 2
    // Written so that a NaN does not pass for a straight curve.
    const double across = (curvature - along * along.dot(curvature)).norm();
    if (!(across <= repose.geodesic_curvature)) repose.geodesic_curvature = across;
    // eps / w at the node. The difference of eps_i / w_i between neighbours is told in parts of that.
    const double ratio = mean / (0.5 * (widths(i) + widths(i - 1)));
    const double uneven = std::abs(along.dot(next / widths(i) - last / widths(i - 1))) / ratio;
    if (!(uneven <= repose.unevenness)) repose.unevenness = uneven;
    last = next;
    last_interval = next_interval;
  }
  return repose;
}

Vector normal_turns(const FlowNodes& nodes) {
  Vector turns(nodes.size() - 1);
  for (Index i = 0; i + 1 < nodes.size(); ++i) {
    const auto here = nodes.normals(i);
    const auto there = nodes.normals(i + 1);
    const Eigen::MatrixXd overlap = here.transpose() * there;
    const double sine = (there - here * overlap).norm();
    // atan2 is exact at small angles, and tells pi from 0.
    turns(i) = nodes.codim() == 1 ? std::atan2(sine, overlap(0, 0)) : sine;
  }
  return turns;
}

}  // namespace taut::detail
