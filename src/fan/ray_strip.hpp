#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fan/panel_basis.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

inline constexpr int kRays = PanelBasis::kRays;
inline constexpr int kStages = PanelBasis::kStages;
inline constexpr int kSeries = PanelBasis::kSeries;

/// A 3-vector a ray, one after the other: 3 x kRays.
using RayVectors = Eigen::Matrix<double, 3 * kRays, 1>;
using RayNumbers = Eigen::Array<double, kRays, 1>;
using RaySeries = Eigen::Matrix<double, 3 * kRays, kStages>;

[[nodiscard]] inline Eigen::Map<const Eigen::Matrix<double, 3, kRays>> by_ray(const RayVectors& a) {
  return Eigen::Map<const Eigen::Matrix<double, 3, kRays>>(a.data());
}
[[nodiscard]] inline Eigen::Map<Eigen::Matrix<double, 3, kRays>> by_ray(RayVectors& a) {
  return Eigen::Map<Eigen::Matrix<double, 3, kRays>>(a.data());
}

/// Neighbouring rays of a fan, all at one arc length from their source: at the nodes of the panel's angles. What lies
/// between them is known by interpolation.
struct RayStrip {
  Index source = 0;
  double value = 0;   ///< of the source: distances count from here
  double angle = 0;   ///< in the middle, radians
  double half = 0;    ///< half the width in angle, radians
  double length = 0;  ///< arc length from the source
  double step = 0;    ///< the next one to try, model units
  RayVectors x;       ///< positions, on the surface
  RayVectors v;       ///< unit tangents
  RayVectors acceleration;
  RayVectors normal;         ///< unit, along grad F
  RayNumbers jacobi;         ///< m12: d x / d angle = jacobi (normal x v)
  RayNumbers slope;          ///< M21 = d m12 / ds
  RaySeries series;          ///< Legendre series of the acceleration along the last step
  double last_step = 0;      ///< 0: there was none
  double error = 0;          ///< what interpolation and steps may have done to the lengths so far, model units
  double interpolation = 0;  ///< error of the last panel's interpolation across the rays, model units
  std::int64_t parent = -1;  ///< the patch it came out of
  /// How far beside the strip its panels count, in half widths: rounding must leave no gap between neighbours. Beyond
  /// the end of a curve a ray would begin nowhere, so less there.
  double rim = 1e-3;
  bool astray = false;  ///< some of its rays have left the surface's domain on the way

  [[nodiscard]] double distance() const { return value + length; }
  /// Width at the widest ray, model units.
  [[nodiscard]] double width() const { return 2 * half * jacobi.abs().maxCoeff(); }
};

}  // namespace taut::detail
