// Why no way was found between two points that the cells connect. In this order: an end is singular; the march stopped
// where the gradient falls to nothing (two sheets or the sides of a neck that nearly touch, or a singular point, by
// Newton's method for grad F = 0); cells that tell too little; a crease at an end; a crease between the ends; else no
// reason is known.
#include "search/find_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/linear_algebra.hpp"
#include "taut/surface/conformance.hpp"

namespace taut::detail {
namespace {

/// |grad F| at a barrier, of that at the ends, below which a singular point is taken to be near (codimension 1).
constexpr double kSingular = 0.05;
/// A critical point is sought within this many cells of the barrier; the surface is taken to be singular there where
/// parts of it come nearer than this to each other, relative to coordinates: rounding hides smaller gaps.
constexpr double kPinchCells = 32;
constexpr double kTouching = 1e-7;
/// How far apart normals are compared, relative to coordinates.
constexpr double kHair = 1e-7;
/// Radians.
constexpr double kLeastCrease = 0.5;

double gradient_share(const Surface& surface, const Barrier& barrier, const Vector& from, const Vector& to) {
  if (surface.codim() > 1) return 1;
  const auto gradient = [&](const Vector& x) { return surface.jacobian(x).norm(); };
  return gradient(barrier.point) / std::min(gradient(from), gradient(to));
}

/// Does the normal jump at x: is it another one a hair's breadth away (codimension 1)?
bool is_corner(const Surface& surface, const Vector& x) {
  if (surface.codim() > 1) return false;
  const double hair = kHair * std::max(1.0, x.norm());
  const Vector normal = surface.jacobian(x).normalized();
  for (Index axis = 0; axis < x.size(); ++axis) {
    for (const double side : {-hair, hair}) {
      const Vector there = surface.jacobian(x + side * Vector::Unit(x.size(), axis)).normalized();
      if (!(normal.dot(there) > std::cos(kLeastCrease))) return true;
    }
  }
  return false;
}

/// A critical point of F near x, where F vanishes too, or two parts of the surface miss each other narrowly.
struct Pinch {
  Vector point;
  double gap = 0;  ///< how far the parts are apart, to second order, model units
};

/// By Newton's method for grad F = 0, within `reach` of x; none where that leads elsewhere (codimension 1).
std::optional<Pinch> find_pinch(const Surface& surface, const Vector& x, double reach) {
  constexpr int kMostSteps = 30;
  constexpr double kStill = 1e-12;  // a step this small, of the reach, is the last
  const Vector weight = Vector::Ones(1);
  Pinch pinch{x, 0};
  for (int step = 0; step < kMostSteps; ++step) {
    const auto hessian = symmetric_eigen(surface.hessian(pinch.point, weight));
    const Vector& curvature = hessian.values;
    const double strongest = curvature.cwiseAbs().maxCoeff();
    const Vector gradient = surface.jacobian(pinch.point);
    if (!(strongest > 0) || !gradient.allFinite()) return std::nullopt;
    // Directions in which F does not bend are left alone.
    constexpr double kFlat = 1e-8;
    const Vector bend = (curvature.array().abs() > kFlat * strongest).select(curvature.array().inverse(), 0.0);
    const Vector move = hessian.vectors * bend.asDiagonal() * (hessian.vectors.transpose() * gradient);
    pinch.point -= move;
    if (!((pinch.point - x).norm() <= reach)) return std::nullopt;
    pinch.gap = 2 * std::sqrt(2 * std::abs(surface.value(pinch.point)(0)) / strongest);
    if (move.norm() > kStill * reach) continue;
    pinch.point = (pinch.point.array().abs() > kStill * reach).select(pinch.point, 0.0);  // rounding, when printed
    return pinch;
  }
  return std::nullopt;
}

}  // namespace

Obstacle find_obstacle(const Surface& surface, const Vector& from, const Vector& to, const Tried& tried) {
  for (const Vector& end : {from, to}) {
    // By comparison with the points around: at the point itself rounding may leave a gradient of 1e-16.
    if (diagnose_rank(surface.function(), VectorIn(end))) return {Obstacle::Kind::singular_end, end};
  }
  const std::optional<Barrier>& barrier = tried.barrier;
  if (barrier && gradient_share(surface, *barrier, from, to) < kSingular) {
    const std::optional<Pinch> pinch = find_pinch(surface, barrier->point, kPinchCells * tried.cell);
    if (pinch && pinch->gap > kTouching * std::max(1.0, pinch->point.norm())) {
      return {Obstacle::Kind::narrow_gap, pinch->point, pinch->gap};
    }
    return {Obstacle::Kind::singular_between, pinch ? pinch->point : barrier->point};
  }
  if (!tried.walked) return {Obstacle::Kind::sheets_not_told};
  if (!tried.resolved) return {Obstacle::Kind::coarse_cells};
  if (is_corner(surface, from)) return {Obstacle::Kind::corner, from};
  if (is_corner(surface, to)) return {Obstacle::Kind::corner, to};
  if (barrier && barrier->turn > kLeastCrease && barrier->turn < std::numbers::pi - kLeastCrease) {
    return {Obstacle::Kind::crease, barrier->point, barrier->turn};
  }
  return {Obstacle::Kind::no_way};
}

}  // namespace taut::detail
