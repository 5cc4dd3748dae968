#include "search/no_way.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

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

double gradient_share(const Surface& surface, const Barrier& barrier, const PathResult& result) {
  if (surface.codim() > 1) return 1;
  const auto gradient = [&](const Vector& x) { return surface.jacobian(x).norm(); };
  return gradient(barrier.point) / std::min(gradient(result.from), gradient(result.to));
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
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> hessian(surface.hessian(pinch.point, weight));
    const Vector& curvature = hessian.eigenvalues();
    const double strongest = curvature.cwiseAbs().maxCoeff();
    const Vector gradient = surface.jacobian(pinch.point);
    if (!(strongest > 0) || !gradient.allFinite()) return std::nullopt;
    // Directions in which F does not bend are left alone.
    constexpr double kFlat = 1e-8;
    const Vector bend = (curvature.array().abs() > kFlat * strongest).select(curvature.array().inverse(), 0.0);
    const Vector move = hessian.eigenvectors() * bend.asDiagonal() * (hessian.eigenvectors().transpose() * gradient);
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

void explain_no_way(PathResult& result, const Surface& surface, const NoWay& no_way) {
  const std::optional<Barrier>& barrier = no_way.barrier;
  result.status = Status::not_converged;
  const bool crease = barrier && barrier->turn > kLeastCrease && barrier->turn < std::numbers::pi - kLeastCrease;
  std::optional<Pinch> pinch;
  const bool vanishing = barrier && gradient_share(surface, *barrier, result) < kSingular;
  if (vanishing) pinch = find_pinch(surface, barrier->point, kPinchCells * result.cell);
  if (pinch && pinch->gap > kTouching * std::max(1.0, pinch->point.norm())) {
    result.message = fmt::format(
        "no path was found on cells down to {:.3g}{}: near ({:.4g}) parts of the surface come within {:.2g} of each "
        "other, be it sheets that nearly touch or the two sides of a thin neck",
        result.cell, no_way.walked ? ", nor by walks from both ends" : "", fmt::join(pinch->point, ", "), pinch->gap);
  } else if (vanishing) {
    result.message = fmt::format(
        "the surface is singular between the two points: near ({:.4g}) its gradient falls to nothing; geodesics "
        "through a singular point are not supported",
        fmt::join(pinch ? pinch->point : barrier->point, ", "));
  } else if (!no_way.walked) {
    result.message = fmt::format(
        "no path was found: cells down to {:.3g} cannot tell the sheets of the surface apart, or the points lie on "
        "different components",
        result.cell);
  } else if (!no_way.resolved) {
    result.message = fmt::format(
        "no path was found, neither on cells of {:.3g}, coarser than the surface bends, nor by walks from both ends; "
        "give a smaller box around both points, or smaller cells",
        result.cell);
  } else if (const Vector* corner = is_corner(surface, result.from) ? &result.from
                                    : is_corner(surface, result.to) ? &result.to
                                                                    : nullptr) {
    result.message = fmt::format(
        "the surface is not smooth at ({:.4g}): its normal jumps there; take a point beside the crease or corner",
        fmt::join(*corner, ", "));
  } else if (crease) {
    result.message = fmt::format(
        "the surface is not smooth between the two points: near ({:.4g}) its normal turns by {:.0f} degrees within a "
        "cell of {:.2g}; geodesics over a crease or through a singular point are not supported",
        fmt::join(barrier->point, ", "), barrier->turn * 180 / std::numbers::pi, result.cell);
  } else {
    result.message = fmt::format(
        "no path was found on cells down to {:.3g}, nor by walks from both ends; that there is none is not proved: a "
        "smaller box around both points may help",
        result.cell);
  }
}

}  // namespace taut::detail
