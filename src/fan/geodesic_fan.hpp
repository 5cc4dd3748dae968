#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

struct FanOptions {
  /// Relative tolerance of distances, 1e-13 .. 1e-3.
  double tolerance = 1e-9;
  /// No panel is longer or wider, model units, > 0. A panel is looked at in some ten places along and across: what is
  /// small beside a tenth of it and changes nothing there is not seen.
  double max_panel = 0;
  /// Panels to be kept at most; about 3.7 kB each.
  Index max_patches = 60000;
  /// Points at which F may be evaluated, about, and panels that may be looked at while rays are compared with shorter
  /// ones: what bounds the time.
  Index max_evaluated = 500'000'000;
};

/// What a fan says of a point.
struct FanHit {
  double distance = 0;                                  ///< infinity where no geodesic of the fan meets the point
  double error = 0;                                     ///< estimated error of `distance`, model units
  Index source = -1;                                    ///< whose geodesic it is: column of the sources, or curve
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();       ///< where it leaves the source: the source itself, or the
                                                        ///< nearest point of the curve
  Eigen::Vector3d departure = Eigen::Vector3d::Zero();  ///< unit tangent at the source
  Eigen::Vector3d arrival = Eigen::Vector3d::Zero();    ///< unit tangent at the point, direction of travel
  /// A shorter geodesic of the fan that may have left the surface's domain on the way, if there is one: its length, and
  /// where it begins. The rest is the shortest of those that have not.
  double astray = std::numeric_limits<double>::infinity();
  double astray_error = 0;
  double astray_value = 0;  ///< of its source
  Index astray_source = -1;
  Eigen::Vector3d astray_foot = Eigen::Vector3d::Zero();
  Eigen::Vector3d astray_departure = Eigen::Vector3d::Zero();
};

/// A curve that rays leave at right angles: geodesics end to end, on the surface, as Newton's method gives them. One
/// that is closed ends where it begins. Of one that turns at its joints, and at its ends, rays leave in all directions
/// in between, too.
struct FanCurve {
  std::vector<SpectralCurve> arcs;
};

/// All geodesics from one or several points of a surface in R^3, as high-order panels of the exponential map (angle,
/// length) -> x, each of which can be solved for the geodesic that meets a given point. Panels are as long and as wide
/// as the tolerance allows; they are split where neighbouring rays part. The least length over all panels is the
/// distance: none is left out but those that can hold no shortest way, because
///   (1) every ray of a strip has passed its first conjugate point, or
///   (2) every ray of a strip is met by shorter geodesics of the fan, even at its nearest by more than the rays lie
///       apart (the distance is 1-Lipschitz).
/// A shortest way stays one no longer than that, so nothing that matters goes with them. Rays follow the surface beyond
/// its domain until all of a strip have left it; then the strip ends, as where rays cannot be followed.
class GeodesicFan {
 public:
  /// `sources` (3 x m) lie on the surface; `values` (m, model units) are the distances there. Throws InvalidArgument
  /// unless d = 3 and k = 1, for options out of range or shapes that do not fit; SingularPoint.
  GeodesicFan(const Surface& surface, const PointsIn& sources, const VectorIn& values, const FanOptions& options);
  /// From curves instead: every ray leaves one at a right angle, so that the least length is the distance from the
  /// nearest of them. Throws as above, and for a curve without arcs.
  GeodesicFan(const Surface& surface, const std::vector<FanCurve>& curves, const FanOptions& options);
  ~GeodesicFan();
  GeodesicFan(GeodesicFan&&) noexcept;
  GeodesicFan& operator=(GeodesicFan&&) noexcept;

  /// Follows all rays at least to this distance, as far as the budget goes. Throws Cancelled.
  void extend(double distance, const Context& context = {});
  /// Up to this distance (values included) every ray has been followed or has ended. Infinity when all have.
  [[nodiscard]] double reach() const;
  /// No way to q that the fan does not hold is shorter: it would go on from where rays could not be followed, where the
  /// surface has a crease, a singular point or an end, and straight from there at best. Infinity where there was no
  /// such place.
  [[nodiscard]] double bound(const Eigen::Vector3d& q) const;
  /// True when extending it leads no farther: all rays have ended, or the budget is used up.
  [[nodiscard]] bool finished() const;
  /// True when rays could not be followed somewhere.
  [[nodiscard]] bool broken() const;
  [[nodiscard]] double tolerance() const;
  [[nodiscard]] Index num_patches() const;
  [[nodiscard]] Index num_evaluated() const;

  /// The least distance on the fan of each target (3 x n, on the surface), on all cores. Exact where `distance` <=
  /// min(reach(), bound(target)) and `astray` is no less; an upper bound elsewhere. Throws Cancelled.
  [[nodiscard]] std::vector<FanHit> locate(const PointsIn& targets, const Context& context = {}) const;
  /// The geodesics of the fan that meet q (on the surface) and are no longer than `longest`, each once, shortest first;
  /// of those that may have left the surface's domain none. Every shortest way is among them where `locate` is exact;
  /// of longer ones those that a strip was given up for are not.
  [[nodiscard]] std::vector<FanHit> ways(const Eigen::Vector3d& q, double longest) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut::detail
