// Parallel transport along a spectral curve.
//
// An orthonormal basis E of the span of the vectors is carried, V = E c: E' = -Q y with II(x', E) = -Q y (see
// ray_field.hpp), by Gauss collocation, solved by fixed-point iteration: the equation is linear and a step turns by
// less than a radian. At the end of every step E is brought back to the tangent space there and made orthonormal again
// by the nearest such basis (polar factor), so that lengths and angles never drift.

#include "taut/curve/exponential_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/linear_algebra.hpp"
#include "curve/curve_stages.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::CurveStages;
using detail::GaussCollocation;

/// The nearest orthonormal basis: Newton's iteration for the polar factor, from one that is nearly orthonormal.
void make_orthonormal(Eigen::MatrixXd& e) {
  constexpr int kSteps = 2;  // 1e-8 -> 1e-16
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::MatrixXd gram = e.transpose() * e;
    e = (e * (1.5 * Eigen::MatrixXd::Identity(gram.rows(), gram.cols()) - 0.5 * gram)).eval();
  }
}

class FrameCarrier {
 public:
  FrameCarrier(const Surface& surface, const SpectralCurve& curve) : stages_(surface), curve_(curve) {}

  /// The tangential parts at the start. False where there is no tangent space.
  bool settle(Points& vectors) {
    if (!stages_.look_at(curve_, 0)) return false;
    to_tangent_space(vectors);
    return true;
  }

  /// `frame` (d x q, orthonormal) from the start of the curve to its end.
  bool carry(Eigen::MatrixXd& frame, int pieces) {
    return detail::along_curve(curve_, pieces, [&](double t, double h) { return step(frame, t, h); });
  }

 private:
  void to_tangent_space(Eigen::MatrixXd& e) const {
    const auto q = stages_.field.normals(0);
    // Twice: what the first pass leaves of the normal part is rounding of a large one.
    for (int pass = 0; pass < 2; ++pass) e -= q * (q.transpose() * e).eval();
  }

  bool step(Eigen::MatrixXd& frame, double t, double h) {
    if (!stages_.look(curve_, t, h)) return false;
    constexpr int kStages = CurveStages::kStages;
    const GaussCollocation& tables = GaussCollocation::tables();
    const Index d = frame.rows();
    const Index q = frame.cols();
    const Eigen::Map<const Eigen::VectorXd> from(frame.data(), d * q);
    frames_ = from.replicate(1, kStages);
    slope_.resize(d * q, kStages);
    constexpr int kMostVisits = 60;
    for (int visit = 0; visit < kMostVisits; ++visit) {
      for (Index i = 0; i < kStages; ++i) {
        stages_.field.bend(i, Eigen::Map<const Eigen::MatrixXd>(frames_.col(i).data(), d, q), y_);
        Eigen::Map<Eigen::MatrixXd>(slope_.col(i).data(), d, q).noalias() = -(stages_.field.normals(i) * y_);
      }
      next_.noalias() = h * slope_ * tables.once;
      next_.colwise() += from;
      const double change = (next_ - frames_).cwiseAbs().maxCoeff();
      frames_.swap(next_);
      // E has entries of at most 1: nothing changes any more.
      if (!(change > std::numeric_limits<double>::epsilon() / 2)) break;
    }
    Eigen::MatrixXd end(d, q);
    Eigen::Map<Eigen::VectorXd>(end.data(), d * q) = from + h * slope_ * tables.end_once.transpose();
    if (!stages_.look_at(curve_, t + h)) return false;
    to_tangent_space(end);
    make_orthonormal(end);
    frame = end;
    return end.allFinite();
  }

  CurveStages stages_;
  const SpectralCurve& curve_;
  Eigen::MatrixXd frames_, next_, slope_;  // d q x kStages
  Eigen::MatrixXd y_;                      // k x q
};

}  // namespace

CarriedVectors parallel_transport(const Surface& surface, const SpectralCurve& curve, const PointsIn& vectors) {
  if (curve.num_elements() == 0 || curve.dim() != surface.dim()) {
    throw InvalidArgument("parallel transport needs a curve on the surface");
  }
  if (vectors.rows() != surface.dim()) {
    throw InvalidArgument(
        fmt::format("vectors have {} components, the surface lies in {} dimensions", vectors.rows(), surface.dim()));
  }
  if (!vectors.allFinite()) throw InvalidArgument("vectors to be carried must be finite");
  CarriedVectors result{.start = vectors, .end = Points::Zero(vectors.rows(), vectors.cols())};
  FrameCarrier carrier(surface, curve);
  if (!carrier.settle(result.start)) {
    result.status = Status::rank_deficient;
    return result;
  }
  if (vectors.cols() == 0) return result;
  // Of many vectors only a basis of their span has to be carried.
  const Eigen::MatrixXd basis = detail::span_basis(result.start);
  if (basis.cols() == 0) return result;
  const Eigen::MatrixXd coordinates = basis.transpose() * result.start;
  Eigen::MatrixXd carried = basis;
  bool regular = true;
  result.error = detail::halve_until_settled([&](int pieces) {
    Eigen::MatrixXd frame = basis;
    regular = carrier.carry(frame, pieces);
    const double change = regular ? (frame - carried).cwiseAbs().maxCoeff() : 0;
    carried = frame;
    return change;
  });
  if (!regular) {
    result.status = Status::rank_deficient;
    return result;
  }
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  result.error += kRounding * static_cast<double>(curve.num_elements());
  result.end = carried * coordinates;
  return result;
}

}  // namespace taut
