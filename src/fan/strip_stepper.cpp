// One step of all rays of a strip, and the patch that they sweep.
//
// Layout: a strip's kRays rays at one stage are a column of 3 kRays numbers, so that kStages columns are at once the
// unknowns of the collocation (one small matrix product a Picard visit) and the batch of points F is evaluated at.
//
// A patch is believed for four reasons that fail independently: the last Chebyshev coefficients along and across are
// small; F vanishes between the nodes; d x / d alpha agrees with the Jacobi fields, which know nothing of the
// neighbouring rays; and normals turn little from node to node.

#include "fan/strip_stepper.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fan/panel_point.hpp"
#include "surface/sign_evaluator.hpp"

namespace taut::detail {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// cos of the largest turn of the normal between neighbouring nodes: 60 degrees.
constexpr double kLeastTurn = 0.5;
/// Between rays (alpha) and from the start to the end of the step (beta): where F is looked at besides the nodes.
constexpr double kCheckAlpha[] = {-1, -0.38, 0.38, 1};
constexpr double kCheckBeta[] = {-0.55, 0.1, 0.72};

/// The last coefficients of a series, the last one first, and how fast they fall.
struct Tail {
  Tail(double a, double b, double c, double d)
      : size(std::max(a, 0.3 * b)), decay(std::sqrt(std::max(a, b) / std::max({c, d, a, b, 1e-300}))) {}
  double size;
  double decay;  ///< from one coefficient to the next, at most 1

  /// The coefficients that the series does not have, if they go on falling so.
  [[nodiscard]] double left_out() const {
    constexpr double kSlowest = 0.8;  // beyond, the function is not smooth enough for this to mean anything
    const double q = std::min(decay, kSlowest);
    return size * q / (1 - q);
  }
  /// Of the end of a step. Gauss collocation leaves a defect that is orthogonal to kStages polynomials there, of which
  /// two derivatives have been taken.
  [[nodiscard]] double left_at_end() const { return size * kStages * kStages * std::pow(decay, kStages); }
};

}  // namespace

StripStepper::StripStepper(const Surface& surface)
    : evaluator_(surface.make_evaluator()),
      value_(kNodes),
      gradient_(3 * kNodes),
      hessian_(9 * kNodes),
      weight_(kNodes, 1.0) {
  if (surface.domain() == nullptr) return;
  domain_ = surface.domain()->make_evaluator();
  domain_codim_ = surface.domain()->codim();
}

bool StripStepper::evaluate(Index n, const double* x) {
  num_evaluated += n;
  evaluator_->evaluate({.n = n,
                        .x = x,
                        .value = value_.data(),
                        .jacobian = gradient_.data(),
                        .weight = weight_.data(),
                        .hessian = hessian_.data()});
  bool fine = true;
  for (Index i = 0; i < n; ++i) {
    const double* g = &gradient_[static_cast<std::size_t>(3 * i)];
    const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    fine = fine && square > 0 && std::isfinite(square) && std::isfinite(value_[static_cast<std::size_t>(i)]);
  }
  return fine;
}

Eigen::Vector3d StripStepper::acceleration(Index i, const Eigen::Vector3d& v) const {
  const Eigen::Map<const Eigen::Vector3d> g(&gradient_[static_cast<std::size_t>(3 * i)]);
  const Eigen::Map<const Eigen::Matrix3d> h(&hessian_[static_cast<std::size_t>(9 * i)]);
  const Eigen::Vector3d hv = h * v;
  return -(v.dot(hv) / g.squaredNorm()) * g;
}

/// Brings ends onto the surface and fills in what is known there.
bool StripStepper::settle_ends(RayVectors& x, RayVectors& v, RayVectors& a, RayVectors& n) {
  if (!evaluate(kRays, x.data())) return false;
  shift_ = 0;
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector3d g(gradient_.data() + 3 * i);
    const double norm = g.norm();
    const Eigen::Vector3d normal = g / norm;
    const double off = value_[static_cast<std::size_t>(i)] / norm;
    shift_ = std::max(shift_, std::abs(off));
    x.segment<3>(3 * i) -= off * normal;
    const Eigen::Vector3d tangent = v.segment<3>(3 * i) - normal * normal.dot(v.segment<3>(3 * i));
    v.segment<3>(3 * i) = tangent / tangent.norm();
    a.segment<3>(3 * i) = acceleration(i, v.segment<3>(3 * i));
    n.segment<3>(3 * i) = normal;
  }
  return x.allFinite() && v.allFinite() && a.allFinite();
}

RayStrip StripStepper::start(const Eigen::Vector3d& x, const Eigen::Vector3d& n, const Eigen::Vector3d& t, double angle,
                             double half) {
  const PanelBasis& basis = PanelBasis::tables();
  RayStrip strip;
  strip.angle = angle;
  strip.half = half;
  const Eigen::Vector3d s = n.cross(t);
  for (int i = 0; i < kRays; ++i) {
    const double theta = angle + half * basis.ray(i);
    strip.x.segment<3>(3 * i) = x;
    strip.v.segment<3>(3 * i) = std::cos(theta) * t + std::sin(theta) * s;
  }
  (void)settle_ends(strip.x, strip.v, strip.acceleration, strip.normal);
  strip.jacobi.setZero();
  strip.slope.setOnes();
  return strip;
}

RayStrip StripStepper::start_beside(const SpectralCurve& curve, double middle, double half, int side) {
  const PanelBasis& basis = PanelBasis::tables();
  RayStrip strip;
  strip.angle = -side * middle;
  strip.half = half;
  for (int i = 0; i < kRays; ++i) {
    const double t = -side * (strip.angle + half * basis.ray(i));
    strip.x.segment<3>(3 * i) = curve.point(t);
    const Eigen::Vector3d along = curve.velocity(t);
    strip.v.segment<3>(3 * i) = along;
    strip.jacobi(i) = along.norm();
  }
  (void)settle_ends(strip.x, strip.v, strip.acceleration, strip.normal);
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector3d normal = strip.normal.segment<3>(3 * i);
    const Eigen::Vector3d along = strip.v.segment<3>(3 * i);
    strip.v.segment<3>(3 * i) = side * normal.cross(along);
  }
  (void)settle_ends(strip.x, strip.v, strip.acceleration, strip.normal);
  strip.rim = 1e-6;
  strip.slope.setZero();  // a geodesic does not bend: neighbouring rays leave it parallel
  return strip;
}

StripStepper::Verdict StripStepper::attempt(const RayStrip& strip, double step, double tolerance) {
  const PanelBasis& basis = PanelBasis::tables();
  step_ = step;
  // First guess: the last step's series carried on, or the acceleration at the start where that leads astray.
  a_.colwise() = strip.acceleration;
  if (strip.last_step > 0) {
    const double most = 2 * std::max(strip.acceleration.cwiseAbs().maxCoeff(), 1e-300);
    PanelBasis::StageSquare ahead;
    for (int i = 0; i < kStages; ++i) legendre_at(1 + basis.node(i) * step / strip.last_step, ahead.col(i).data());
    const RaySeries guess = strip.series.lazyProduct(ahead);
    for (int i = 0; i < kStages && guess.col(i).cwiseAbs().maxCoeff() <= most; ++i) a_.col(i) = guess.col(i);
  }
  constexpr int kMostVisits = 30;
  const double enough = std::max(0.01 * tolerance, kEpsilon * step);
  double last = std::numeric_limits<double>::infinity();
  for (int visit = 0;; ++visit) {
    place_nodes(strip);
    if (!evaluate(kNodes, x_.data())) return Verdict::not_finite;
    double change = 0;
    for (Index i = 0; i < kNodes; ++i) {
      const Eigen::Vector3d a = acceleration(i, Eigen::Map<const Eigen::Vector3d>(v_.data() + 3 * i));
      Eigen::Map<Eigen::Vector3d> old(a_.data() + 3 * i);
      change = std::max(change, (a - old).cwiseAbs().maxCoeff());
      old = a;
    }
    change *= step * step;
    const double ahead = visit > 0 ? change * std::min(1.0, change / last) : change;
    if (ahead <= enough) break;
    if (!(change <= 100 * step) || visit + 1 == kMostVisits) return Verdict::diverged;
    if (visit > 2 && change > 0.7 * last) return Verdict::diverged;
    last = change;
    turn_by_hessians(strip);
  }
  if (!a_.allFinite()) return Verdict::not_finite;
  off_along = 0;
  for (std::size_t p = 0; p < kNodes; ++p) {
    off_along = std::max(off_along, std::abs(value_[p]) / Eigen::Map<const Eigen::Vector3d>(&gradient_[3 * p]).norm());
  }
  series_.noalias() = (step * step) * a_.lazyProduct(basis.twice_series);
  series_.col(0) += strip.x + step / 2 * strip.v;
  series_.col(1) += step / 2 * strip.v;
  end_x_ = strip.x + step * strip.v;
  end_x_.noalias() += (step * step) * (a_ * basis.end_twice.transpose());
  end_v_ = strip.v;
  end_v_.noalias() += step * (a_ * basis.end_once.transpose());
  follow_fields(strip);
  for (int n = 0; n < kSeries; ++n) {  // values at the rays -> series across them
    const RayVectors values = series_.col(n);
    RayVectors column;
    by_ray(column).noalias() = by_ray(values) * basis.ray_series.transpose();
    series_.col(n) = column;
  }
  if (!check(strip)) return Verdict::diverged;
  look_at_domain();
  return Verdict::good;
}

/// Velocities and positions at the stages, of the accelerations.
void StripStepper::place_nodes(const RayStrip& strip) {
  const PanelBasis& basis = PanelBasis::tables();
  v_.noalias() = step_ * a_.lazyProduct(basis.once);
  v_.colwise() += strip.v;
  x_.noalias() = (step_ * step_) * a_.lazyProduct(basis.twice);
  x_.noalias() += (step_ * strip.v).lazyProduct(basis.node);
  x_.colwise() += strip.x;
}

/// Half an iteration more between two visits, without a look at F: the nodes move on, and gradients turn with them by
/// the Hessians of the last visit. What is left is of third derivatives; a panel takes 3.2 visits in place of 4.0.
void StripStepper::turn_by_hessians(const RayStrip& strip) {
  visited_ = x_;
  place_nodes(strip);
  for (Index i = 0; i < kNodes; ++i) {
    const std::size_t p = static_cast<std::size_t>(i);
    const Eigen::Map<const Eigen::Matrix3d> h(&hessian_[9 * p]);
    const Eigen::Map<const Eigen::Vector3d> v(v_.data() + 3 * i);
    const Eigen::Vector3d moved = Eigen::Map<const Eigen::Vector3d>(x_.data() + 3 * i) -
                                  Eigen::Map<const Eigen::Vector3d>(visited_.data() + 3 * i);
    const Eigen::Vector3d g = Eigen::Map<const Eigen::Vector3d>(&gradient_[3 * p]) + h * moved;
    const Eigen::Vector3d hv = h * v;
    Eigen::Map<Eigen::Vector3d>(a_.data() + 3 * i) = -(v.dot(hv) / g.squaredNorm()) * g;
  }
}

/// Gaussian curvature at the nodes, K = (H(e, e) H(v, v) - H(e, v)^2) / |g|^2 with e = n x v, and the Jacobi fields.
void StripStepper::follow_fields(const RayStrip& strip) {
  const PanelBasis& basis = PanelBasis::tables();
  for (int s = 0; s < kStages; ++s) {
    for (int i = 0; i < kRays; ++i) {
      const std::size_t p = static_cast<std::size_t>(s * kRays + i);
      const Eigen::Map<const Eigen::Vector3d> g(&gradient_[3 * p]);
      const Eigen::Map<const Eigen::Matrix3d> h(&hessian_[9 * p]);
      const Eigen::Vector3d v = v_.col(s).segment<3>(3 * i);
      const double norm = g.norm();
      const Eigen::Vector3d n = g / norm;
      const Eigen::Vector3d e = n.cross(v);
      const Eigen::Vector3d he = h * e;
      const double ev = he.dot(v);
      curvature_(i, s) = (e.dot(he) * v.dot(h * v) - ev * ev) / (norm * norm);
      normals_.col(s).segment<3>(3 * i) = n;
    }
  }
  const double h = step_;
  Eigen::Array<double, kRays, kStages> straight;
  straight =
      (strip.jacobi.matrix() * Eigen::Matrix<double, 1, kStages>::Ones() + (h * strip.slope).matrix() * basis.node)
          .array();
  fields_ = straight;
  Eigen::Matrix<double, kRays, kStages> pull;
  for (int visit = 0; visit < 40; ++visit) {
    pull = -(curvature_ * fields_).matrix();
    const Eigen::Array<double, kRays, kStages> next =
        straight + (h * h) * Eigen::Matrix<double, kRays, kStages>(pull.lazyProduct(basis.twice)).array();
    const double change = (next - fields_).abs().maxCoeff();
    fields_ = next;
    if (!(change > 1e-13 * fields_.abs().maxCoeff())) break;
  }
  pull = -(curvature_ * fields_).matrix();
  end_jacobi_ = strip.jacobi + h * strip.slope + (h * h) * (pull * basis.end_twice.transpose()).array();
  end_slope_ = strip.slope + h * (pull * basis.end_once.transpose()).array();
}

bool StripStepper::check(const RayStrip& strip) {
  const PanelBasis& basis = PanelBasis::tables();
  // Coefficients of one parity may vanish, so two of them count; how they fall tells what is left out.
  const auto across = [&](int m) {
    double sum = 0;
    for (int n = 0; n < kSeries; ++n) sum += series_.col(n).segment<3>(3 * m).norm();
    return sum;
  };
  const auto along = [&](int n) {
    double sum = 0;
    for (int m = 0; m < kRays; ++m) sum += series_.col(n).segment<3>(3 * m).norm();
    return sum;
  };
  const Tail tail_across(across(kRays - 1), across(kRays - 2), across(kRays - 3), across(kRays - 4));
  const Tail tail_along(along(kSeries - 1), along(kSeries - 2), along(kSeries - 3), along(kSeries - 4));
  error_across = tail_across.size;
  error_along = tail_along.size;
  left_across_ = tail_across.left_out();
  left_along_ = tail_along.left_out();
  left_at_end_ = std::min(tail_along.size, tail_along.left_at_end());
  width = 2 * strip.half *
          std::max({strip.jacobi.abs().maxCoeff(), fields_.abs().maxCoeff(), end_jacobi_.abs().maxCoeff()});

  // d x / d alpha at the end, against the Jacobi fields.
  Eigen::Matrix<double, 3, kRays> slope;
  slope.noalias() = by_ray(end_x_) * basis.ray_slope.transpose();
  if (!settle_ends(end_x_, end_v_, end_a_, end_n_)) return false;
  mismatch = 0;
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector3d e = end_n_.segment<3>(3 * i).cross(end_v_.segment<3>(3 * i));
    mismatch = std::max(mismatch, (slope.col(i) - strip.half * end_jacobi_(i) * e).norm());
  }

  const auto close = [](const auto& a, const auto& b) { return a.dot(b) > kLeastTurn; };
  for (int i = 0; i < kRays; ++i) {
    if (!close(strip.normal.segment<3>(3 * i), normals_.col(0).segment<3>(3 * i))) return false;
    for (int s = 0; s < kStages; ++s) {
      const auto n = normals_.col(s).segment<3>(3 * i);
      if (i + 1 < kRays && !close(n, normals_.col(s).segment<3>(3 * i + 3))) return false;
      if (s + 1 < kStages && !close(n, normals_.col(s + 1).segment<3>(3 * i))) return false;
    }
    if (!close(normals_.col(kStages - 1).segment<3>(3 * i), end_n_.segment<3>(3 * i))) return false;
  }

  double points[3 * kChecks];
  int count = 0;
  for (const double beta : kCheckBeta) {
    double tb[kSeries];
    chebyshev(beta, kSeries, tb);
    const RayVectors values = series_ * Eigen::Map<const Eigen::Matrix<double, kSeries, 1>>(tb);
    for (const double alpha : kCheckAlpha) {
      double ta[kRays];
      chebyshev(alpha, kRays, ta);
      Eigen::Map<Eigen::Vector3d>(points + 3 * count++) =
          by_ray(values) * Eigen::Map<const Eigen::Matrix<double, kRays, 1>>(ta);
    }
  }
  if (!evaluate(kChecks, points)) return false;
  off_surface = shift_;
  for (std::size_t p = 0; p < kChecks; ++p) {
    const Eigen::Map<const Eigen::Vector3d> g(&gradient_[3 * p]);
    off_surface = std::max(off_surface, std::abs(value_[p]) / g.norm());
  }
  return std::isfinite(mismatch + error_across + error_along + off_surface + width);
}

/// Which of the rays have left the domain.
void StripStepper::look_at_domain() {
  inside = true;
  gone = false;
  if (!domain_) return;
  const auto count_outside = [&](Index n, const double* x) {
    are_nonnegative(*domain_, domain_codim_, n, x, node_inside_.data());
    return std::count(node_inside_.begin(), node_inside_.begin() + n, false);
  };
  const Index at_end = count_outside(kRays, end_x_.data());
  gone = at_end == kRays;
  inside = at_end == 0 && count_outside(kNodes, x_.data()) == 0;
}

std::pair<PatchFrame, ExpPatch> StripStepper::patch(const RayStrip& strip) const {
  const PanelBasis& basis = PanelBasis::tables();
  ExpPatch patch{.series = series_,
                 .angle = strip.angle,
                 .half = strip.half,
                 .length = strip.length,
                 .step = step_,
                 .value = strip.value,
                 .error = strip.error + left_along_ + left_across_ + off_surface,
                 .source = static_cast<std::int32_t>(strip.source),
                 .rim = strip.rim,
                 .beside_curve = strip.length == 0 && strip.slope.abs().maxCoeff() == 0,
                 .astray = strip.astray || !inside,
                 .sketch = 0};
  patch.sketch = sketch_error(patch);
  PatchFrame frame;
  frame.start = strip.distance();
  // x and its derivatives in the middle: T_n(0) = 1, 0, -1, 0, ..., T_n'(0) = 0, n, 0, -n, ...
  double t[kSeries > kRays ? kSeries : kRays];
  double s[kSeries > kRays ? kSeries : kRays];
  chebyshev_slopes(0, kSeries > kRays ? kSeries : kRays, t, s);
  const RayVectors middle = series_ * Eigen::Map<const Eigen::Matrix<double, kSeries, 1>>(t);
  const RayVectors middle_slope = series_ * Eigen::Map<const Eigen::Matrix<double, kSeries, 1>>(s);
  const Eigen::Map<const Eigen::Matrix<double, kRays, 1>> tr(t);
  const Eigen::Map<const Eigen::Matrix<double, kRays, 1>> sr(s);
  frame.centre = by_ray(middle) * tr;
  const Eigen::Vector3d across = by_ray(middle) * sr;
  const Eigen::Vector3d along = by_ray(middle_slope) * tr;
  frame.along = along / along.squaredNorm();
  const double half_step = step_ / 2;
  // Rays that meet in the middle have no first-order alpha there: it says nothing then.
  const double square = across.squaredNorm() + 1e-6 * half_step * half_step;
  frame.across = across / square;
  frame.normal = normals_.col(kStages / 2).segment<3>(3 * (kRays / 2));

  frame.lower.setConstant(std::numeric_limits<double>::infinity());
  frame.upper = -frame.lower;
  frame.least_height = std::numeric_limits<double>::infinity();
  frame.most_height = -frame.least_height;
  double stray_alpha = 0;
  double stray_beta = 0;
  const auto take = [&](const RayVectors& x, double beta) {
    for (int i = 0; i < kRays; ++i) {
      const Eigen::Vector3d p = x.segment<3>(3 * i);
      frame.lower = frame.lower.min(p.array());
      frame.upper = frame.upper.max(p.array());
      const Eigen::Vector3d r = p - frame.centre;
      stray_alpha = std::max(stray_alpha, std::abs(r.dot(frame.across) - basis.ray(i)));
      stray_beta = std::max(stray_beta, std::abs(r.dot(frame.along) - beta));
      const double height = r.dot(frame.normal);
      frame.least_height = std::min(frame.least_height, height);
      frame.most_height = std::max(frame.most_height, height);
    }
  };
  take(strip.x, -1);
  for (int n = 0; n < kStages; ++n) take(x_.col(n), 2 * basis.node(n) - 1);
  take(end_x_, 1);
  // Nodes are samples: between and beside them a little more is allowed.
  constexpr double kMore = 0.06;
  const Eigen::Array3d margin = kMore * (frame.upper - frame.lower).maxCoeff() + Eigen::Array3d::Zero();
  frame.lower -= margin;
  frame.upper += margin;
  const double thick = frame.most_height - frame.least_height;
  const double haze = kMore * thick + 1e-3 * step_;
  frame.least_height -= haze;
  frame.most_height += haze;
  // Up to here Gauss-Newton arrives from the first-order guess; beyond (a caustic) it was seen to take another branch.
  constexpr double kStraight = 0.7;
  frame.bent = std::max(stray_alpha, stray_beta) > kStraight;
  frame.even = goes_like_first_order(strip, frame);
  frame.most_alpha = 1.1 + 1.2 * stray_alpha;
  frame.most_beta = 1.1 + 1.2 * stray_beta;
  return {frame, patch};
}

/// The Jacobian of ((q - centre) . across, (q - centre) . along) by (alpha, beta), from the Jacobi fields, is so near
/// the identity at all nodes that the map takes no two places to one.
bool StripStepper::goes_like_first_order(const RayStrip& strip, const PatchFrame& frame) const {
  constexpr double kMostOff = 0.6;  // below 1: nodes are samples
  double most = 0;
  for (int s = 0; s < kStages; ++s) {
    for (int i = 0; i < kRays; ++i) {
      const Eigen::Vector3d v = v_.col(s).segment<3>(3 * i);
      const Eigen::Vector3d n = normals_.col(s).segment<3>(3 * i);
      const Eigen::Vector3d across = strip.half * fields_(i, s) * n.cross(v);
      const Eigen::Vector3d along = step_ / 2 * v;
      most = std::max({most, std::abs(across.dot(frame.across) - 1) + std::abs(along.dot(frame.across)),
                       std::abs(along.dot(frame.along) - 1) + std::abs(across.dot(frame.along))});
    }
  }
  return most < kMostOff;
}

void StripStepper::arrive(RayStrip& strip) const {
  strip.length += step_;
  strip.x = end_x_;
  strip.v = end_v_;
  strip.acceleration = end_a_;
  strip.normal = end_n_;
  strip.jacobi = end_jacobi_;
  strip.slope = end_slope_;
  strip.series.noalias() = a_.lazyProduct(PanelBasis::tables().to_legendre);
  strip.last_step = step_;
  strip.astray = strip.astray || !inside;
  strip.interpolation = left_across_;
  strip.error += left_at_end_ + shift_;
}

bool StripStepper::split(const RayStrip& strip, RayStrip& lower, RayStrip& upper) {
  const PanelBasis& basis = PanelBasis::tables();
  for (int side = 0; side < 2; ++side) {
    RayStrip& child = side == 0 ? lower : upper;
    child = strip;
    child.half = strip.half / 2;
    child.angle = strip.angle + (side == 0 ? -child.half : child.half);
    const PanelBasis::RaySquare& half = basis.half[side];
    by_ray(child.x).noalias() = by_ray(strip.x) * half.transpose();
    by_ray(child.v).noalias() = by_ray(strip.v) * half.transpose();
    child.jacobi = (half * strip.jacobi.matrix()).array();
    child.slope = (half * strip.slope.matrix()).array();
    for (int n = 0; n < kStages; ++n) {
      const RayVectors column = strip.series.col(n);
      RayVectors halved;
      by_ray(halved).noalias() = by_ray(column) * half.transpose();
      child.series.col(n) = halved;
    }
    if (!settle_ends(child.x, child.v, child.acceleration, child.normal)) return false;
    child.error += strip.interpolation + shift_;
  }
  return true;
}

}  // namespace taut::detail
