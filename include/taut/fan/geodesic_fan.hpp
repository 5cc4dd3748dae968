#pragma once

#include <memory>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct FanOptions {
  /// Relative tolerance of distances, 1e-13 .. 1e-3.
  double tolerance = 1e-9;
  /// No panel is longer or wider, model units, > 0. A panel is looked at in some ten places along and across: what is
  /// small beside a tenth of it and changes nothing there is not seen.
  double max_panel = 0;
  /// Panels to be kept at most; about 3.7 kB each.
  Index max_patches = 60000;
};

/// What a fan says of a point.
struct FanHit {
  double distance = 0;                                  ///< infinity where no geodesic of the fan meets the point
  double error = 0;                                     ///< estimated error of `distance`, model units
  Index source = -1;                                    ///< whose geodesic it is
  Eigen::Vector3d departure = Eigen::Vector3d::Zero();  ///< unit tangent at the source
  Eigen::Vector3d arrival = Eigen::Vector3d::Zero();    ///< unit tangent at the point, direction of travel
};

/// All geodesics from one or several points of a surface in R^3, as high-order panels of the exponential map (angle,
/// length) -> x, each of which can be solved for the geodesic that meets a given point. Panels are as long and as wide
/// as the tolerance allows; they are split where neighbouring rays part. The least length over all panels is the
/// distance: none is left out but those that can hold no shortest way, because
///   (1) every ray of a strip has passed its first conjugate point, or
///   (2) every ray of a strip is met by shorter geodesics of the fan, even at its nearest by more than the rays lie
///       apart (the distance is 1-Lipschitz).
/// A shortest way stays one no longer than that, so nothing that matters goes with them.
class GeodesicFan {
 public:
  /// `sources` (3 x m) lie on the surface; `values` (m, model units) are the distances there. Throws InvalidArgument
  /// unless d = 3 and k = 1, for options out of range or shapes that do not fit; SingularPoint.
  GeodesicFan(const Surface& surface, const PointsIn& sources, const VectorIn& values, const FanOptions& options);
  ~GeodesicFan();
  GeodesicFan(GeodesicFan&&) noexcept;
  GeodesicFan& operator=(GeodesicFan&&) noexcept;

  /// Follows all rays at least to this distance, as far as the budget goes. Throws Cancelled.
  void extend(double distance, const Context& context = {});
  /// Up to this distance (values included) the fan holds every shortest way. Infinity when it holds them all.
  [[nodiscard]] double reach() const;
  /// True when extending it leads no farther: all rays have ended, some cannot be followed, or the budget is used up.
  [[nodiscard]] bool finished() const;
  /// Least distance at which rays could not be followed, where the surface has a crease, a singular point or an end;
  /// infinity where there was none.
  [[nodiscard]] double broken_at() const;
  [[nodiscard]] Index num_patches() const;
  [[nodiscard]] Index num_evaluated() const;

  /// The least distance on the fan of each target (3 x n, on the surface), on all cores. Exact where `distance` <=
  /// reach(); an upper bound elsewhere. Throws Cancelled.
  [[nodiscard]] std::vector<FanHit> locate(const PointsIn& targets, const Context& context = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
