#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "surface/local_fit/cubic.hpp"

namespace taut::detail {

/// An interval, outward-rounded by whoever fills it.
struct PatchRange {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void include(double from, double to) {
    lower = std::min(lower, from);
    upper = std::max(upper, to);
  }
  [[nodiscard]] bool has_zero() const { return lower <= 0 && upper >= 0; }
  static PatchRange unknown() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
};

/// A closed box by its middle and half its edges.
template <int D>
struct MiddleBox {
  std::array<double, D> lower{};
  std::array<double, D> upper{};
  std::array<double, D> middle{};
  std::array<double, D> half{};
  double half_diagonal = 0;

  MiddleBox(const double* from, const double* to) {
    double squared = 0;
    for (std::size_t a = 0; a < D; ++a) {
      lower[a] = from[a];
      upper[a] = to[a];
      middle[a] = 0.5 * (from[a] + to[a]);
      half[a] = std::max(to[a] - middle[a], middle[a] - from[a]);
      squared += half[a] * half[a];
    }
    half_diagonal = std::sqrt(squared);
  }
};

enum class BallMeets { nothing, part, whole };

/// Adds to `range` what a patch's polynomial does on the part of the box next to its ball, by Taylor's formula at the
/// middle of that part, which is exact for a cubic. Says how much of the box the ball holds: the whole if no point of
/// it is farther from the centre than the part `sure` of the radius.
template <int D>
BallMeets include_patch(const Patch<D>& patch, const MiddleBox<D>& box, double sure, PatchRange& range) {
  constexpr double kEps = std::numeric_limits<double>::epsilon();
  const double per_radius = 1 / patch.radius;
  double least = 0;  // squared distances of the box to the centre, in radii
  double most = 0;
  std::array<double, D> u{};  // the middle of what the box has in common with the cube around the ball
  std::array<double, D> half{};
  for (std::size_t a = 0; a < D; ++a) {
    const double from = (box.lower[a] - patch.centre[a]) * per_radius;
    const double to = (box.upper[a] - patch.centre[a]) * per_radius;
    const double off = std::max({from, -to, 0.0});
    const double far = std::max(-from, to);
    least += off * off;
    most += far * far;
    u[a] = 0.5 * (std::clamp(from, -1.0, 1.0) + std::clamp(to, -1.0, 1.0));
    half[a] = 0.5 * (std::clamp(to, -1.0, 1.0) - std::clamp(from, -1.0, 1.0)) + 4 * kEps;
  }
  if (least >= 1 + 8 * kEps) return BallMeets::nothing;
  std::array<double, D> gradient{};
  std::array<double, Cubic<D>::kPairs> hessian{};
  patch.cubic.derivatives(u, gradient, hessian);
  const double value = patch.cubic.value(u);
  double reach = patch.cubic.curvature_reach(u, half);
  for (std::size_t a = 0; a < D; ++a) reach += std::abs(gradient[a]) * half[a];
  double size = 0;
  for (const double c : patch.cubic.coefficient) size += std::abs(c);
  // Both here and at the points: a few roundings of sums whose terms are below the coefficients (|u| <= 1), and of u
  // itself, of which the centre's coordinates decide.
  double slack = 256 * kEps * size;
  for (std::size_t a = 0; a < D; ++a) slack += 4 * kEps * size * std::abs(patch.centre[a]) * per_radius;
  range.include(patch.radius * (value - reach - slack), patch.radius * (value + reach + slack));
  return most <= sure * sure ? BallMeets::whole : BallMeets::part;
}

/// Adds to `range` what the plane through a patch's centre does on the box.
template <int D>
void include_plane(const Patch<D>& patch, const MiddleBox<D>& box, PatchRange& range) {
  constexpr double kEps = std::numeric_limits<double>::epsilon();
  double value = patch.radius * patch.cubic.coefficient[0];
  double reach = 0;
  double size = std::abs(value);
  for (std::size_t a = 0; a < D; ++a) {
    const double slope = patch.cubic.coefficient[Cubic<D>::kLinear + a];
    value += slope * (box.middle[a] - patch.centre[a]);
    reach += std::abs(slope) * box.half[a];
    size += std::abs(slope) * (std::abs(box.middle[a]) + std::abs(patch.centre[a]) + box.half[a]);
  }
  range.include(value - reach - 16 * kEps * size, value + reach + 16 * kEps * size);
}

}  // namespace taut::detail
