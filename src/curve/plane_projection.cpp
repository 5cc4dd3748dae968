// The paper's equation (5): the point of the surface in the plane through p' across a gap. Newton's method for F = 0
// within the plane: the Jacobian J (k x d) is restricted to it, J Pi with Pi = I - a a^T, and a step is the shortest
// solution there, -(J Pi)^+ F. A step is halved while the distance |J^+ F| does not fall; no point leaves a ball about
// its p'. All points of a batch advance together, a visit a round, at most kMaxSteps; one that has arrived, or whose
// steps have become shorter than the tolerance, drops out.
#include "curve/plane_projection.hpp"
#include "core/linear_algebra.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace taut::detail {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kNearEnough = 1e-5;  // of the radius

/// -(J Pi)^+ F with Pi = I - a a^T. `gradients`: d x k.
Vector step_in_plane(const Eigen::Ref<const Eigen::MatrixXd>& gradients, const VectorIn& value, const VectorIn& axis) {
  const Eigen::MatrixXd restricted = gradients - axis * (axis.transpose() * gradients);
  if (gradients.cols() == 1) return restricted.col(0) * (-value(0) / restricted.squaredNorm());
  return -least_squares(restricted.transpose(), value);
}

/// Length of J^+ F: how far from the surface, to first order.
double residual_of(const Eigen::Ref<const Eigen::MatrixXd>& gradients, const VectorIn& value) {
  if (gradients.cols() == 1) return std::abs(value(0)) / gradients.norm();
  return least_squares(gradients.transpose(), value).norm();
}

}  // namespace

Eigen::Array<bool, Eigen::Dynamic, 1> project_in_planes(Evaluator& evaluator, Index dim, Index codim,
                                                        Eigen::Ref<Points> points, const PointsIn& axes,
                                                        const VectorIn& radius, double tolerance) {
  const Index n = points.cols();
  const Index d = dim;
  const Index k = codim;
  Eigen::Array<bool, Eigen::Dynamic, 1> found = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(n, false);
  const Points origin = points;
  Points step = Points::Zero(d, n);
  Vector residual = Vector::Constant(n, std::numeric_limits<double>::infinity());
  std::vector<Index> active(static_cast<std::size_t>(n));
  for (Index j = 0; j < n; ++j) active[static_cast<std::size_t>(j)] = j;

  Points trial;
  Points value;
  Points jacobian;
  for (int round = 0; round < kMaxSteps && !active.empty(); ++round) {
    const auto count = static_cast<Index>(active.size());
    trial.resize(d, count);
    value.resize(k, count);
    jacobian.resize(d * k, count);
    for (Index a = 0; a < count; ++a) {
      const Index j = active[static_cast<std::size_t>(a)];
      trial.col(a) = points.col(j) + step.col(j);
    }
    evaluator.evaluate({.n = count, .x = trial.data(), .value = value.data(), .jacobian = jacobian.data()});
    std::vector<Index> still;
    for (Index a = 0; a < count; ++a) {
      const Index j = active[static_cast<std::size_t>(a)];
      const auto gradients = Eigen::Map<const Eigen::MatrixXd>(jacobian.data() + a * d * k, d, k);
      const double at_trial = residual_of(gradients, value.col(a));
      // The first visit is at p' itself, with a step of zero and nothing known: always better, if finite.
      const bool better = at_trial < residual(j);
      if (!better && std::isfinite(residual(j))) {  // overshot: half the step
        step.col(j) *= 0.5;
        if (step.col(j).norm() > 0.5 * tolerance) still.push_back(j);
        continue;
      }
      if (!std::isfinite(at_trial)) continue;
      points.col(j) = trial.col(a);
      residual(j) = at_trial;
      if (at_trial <= tolerance) {
        found(j) = true;
        continue;
      }
      step.col(j) = step_in_plane(gradients, value.col(a), axes.col(j));
      if (!step.col(j).allFinite()) continue;
      // Where the gradient in the plane is small, Newton's step would be as long as one likes.
      const double longest = 0.5 * radius(j);
      const double size = step.col(j).norm();
      if (size > longest) step.col(j) *= longest / size;
      const Vector reach = points.col(j) + step.col(j) - origin.col(j);
      // To the border of the ball, in the direction of where it would have led.
      if (reach.norm() > radius(j)) step.col(j) = origin.col(j) + reach * (radius(j) / reach.norm()) - points.col(j);
      if (step.col(j).norm() > 0) still.push_back(j);
    }
    active = std::move(still);
  }
  // Where noise of F ends the iteration early, a point this near is on the surface all the same.
  for (Index j = 0; j < n; ++j) found(j) = found(j) || residual(j) <= kNearEnough * radius(j);
  return found;
}

}  // namespace taut::detail
