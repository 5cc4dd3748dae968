#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fan/ray_strip.hpp"

namespace taut::detail {

/// What tells quickly that a point is not on a patch, and where to begin if it may be.
struct PatchFrame {
  Eigen::Array3d lower, upper;  ///< box, model units
  Eigen::Vector3d centre;
  Eigen::Vector3d across;  ///< covectors: (q - centre) . across is alpha to first order, - . along is beta
  Eigen::Vector3d along;
  Eigen::Vector3d normal;
  double most_alpha, most_beta;      ///< how far first order goes astray: |alpha|, |beta| of points on the patch
  double least_height, most_height;  ///< (q - centre) . normal of points on the patch
  double start;                      ///< least distance on it
  bool bent;                         ///< first order is no good guess everywhere
  bool even;                         ///< the map goes like first order everywhere: it meets no point twice
};

/// A panel of the exponential map, (alpha, beta) in [-1, 1]^2 -> x: angle = middle + half alpha, arc length = start +
/// step (beta + 1) / 2. Chebyshev coefficients: column n belongs to T_n(beta), rows 3 m .. 3 m + 2 to T_m(alpha).
struct ExpPatch {
  Eigen::Matrix<double, 3 * kRays, kSeries> series;
  double angle, half;
  double length, step;
  double value;
  double error;  ///< of the distances it gives, model units
  std::int32_t source;
  double rim;         ///< what |alpha| may be beyond 1
  bool beside_curve;  ///< it begins at a curve: rays do not meet there
  bool astray;        ///< some of its rays have left the surface's domain, on it or before
  double sketch;      ///< how far its first terms alone are off (sketch_error), model units
};

/// Where a patch's map meets a point.
struct PatchHit {
  double distance = 0;                                ///< from the source, its value included
  double angle = 0;                                   ///< of the direction at the source, radians
  Eigen::Vector3d arrival = Eigen::Vector3d::Zero();  ///< unit: direction in which the geodesic arrives
  double error = 0;                                   ///< model units
};

/// Solves x(alpha, beta) = q by Gauss-Newton from (alpha, beta); by Gauss' lemma its normal equations are diagonal.
/// True where the point is on the patch (or by a hair beside it). `even`: as PatchFrame::even.
[[nodiscard]] bool invert(const ExpPatch& patch, const Eigen::Vector3d& q, double alpha, double beta, bool even,
                          PatchHit& hit);

/// The same from the first-order guess; where that goes far astray, because rays meet on the patch, from several
/// starts: the least distance. `frame` and `patch` belong together.
[[nodiscard]] bool invert(const PatchFrame& frame, const ExpPatch& patch, const Eigen::Vector3d& q, PatchHit& hit);

/// False where q is certainly not on the patch.
[[nodiscard]] inline bool may_hold(const PatchFrame& frame, const Eigen::Vector3d& q) {
  if ((q.array() < frame.lower).any() || (q.array() > frame.upper).any()) return false;
  const Eigen::Vector3d r = q - frame.centre;
  const double height = r.dot(frame.normal);
  if (height < frame.least_height || height > frame.most_height) return false;
  return std::abs(r.dot(frame.across)) <= frame.most_alpha && std::abs(r.dot(frame.along)) <= frame.most_beta;
}

}  // namespace taut::detail
