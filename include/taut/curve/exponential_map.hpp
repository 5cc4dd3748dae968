#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string_view>

#include "taut/core/context.hpp"
#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct ExponentialOptions {
  /// Error of each step, radians and relative to the step's length; 1e-3 .. 0. 0 = as near to rounding as F allows.
  double tolerance = 0;
  int max_steps = 100000;  ///< accepted steps, >= 1
  /// Look for conjugate points. In more than a few dimensions that costs far more than the ray: q = d - k - 1
  /// Hessian products a point, and products of dense q x q matrices.
  bool conjugate = true;
  /// With q above this, conjugate points are not looked for, and the error estimate rests on three neighbouring rays
  /// instead of Jacobi fields. The same without `conjugate` for q > 8.
  Index max_fields = 64;
  bool points = true;  ///< fill `ExponentialResult::points`
};

/// A geodesic given by its start.
struct ExponentialResult {
  Status status = Status::not_converged;
  Vector point;       ///< d: gamma(length), on the surface
  Vector direction;   ///< d: gamma'(length), a unit tangent
  double length = 0;  ///< how far it went, with the sign asked for: less than asked for where it had to stop
  double error = 0;   ///< honest estimate of the error of `point`, model units: what every step may have added, grown
                      ///< along the rest of the way, and the rounding of the start
  double direction_error = 0;  ///< the same for `direction`, radians
  /// How much an error at the start may have grown at the end: the largest of the Jacobi fields that start with value
  /// or slope 1, and their slopes; at least 1. exp(20) for a ray of length 20 where K = -1.
  double amplification = 1;
  /// Arc length from the start (with the sign of `length`) of the first conjugate point, up to the end of the ray.
  std::optional<double> conjugate_at;
  double conjugate_searched = 0;  ///< up to where it was looked for: `length`, or 0 where it was not
  /// How many there are up to there, each as often as its multiplicity: the Morse index of the ray (one at the very
  /// end may or may not count).
  int index = 0;
  double off_surface = 0;  ///< largest |J^+ F| at the ends of the steps, model units
  /// d x m, from the start to `point`, every one on the surface: what to draw or write.
  Points points;
  int num_steps = 0;
  Index num_evaluated = 0;  ///< points at which F and its derivatives were evaluated
  /// Why the status is not ok, in a few words for people; empty when it is.
  std::string_view reason;
};

/// exp_p on one surface, again and again: keeps the evaluators and all workspace. Not for sharing between threads.
/// See docs/exp.md.
class ExponentialMap {
 public:
  /// Throws InvalidArgument when an option breaks its rule.
  explicit ExponentialMap(const Surface& surface, const ExponentialOptions& options = {});
  ~ExponentialMap();
  ExponentialMap(ExponentialMap&&) noexcept;
  ExponentialMap& operator=(ExponentialMap&&) noexcept;

  /// Follows the geodesic x'' = -J^T (J J^T)^-1 (x' . H_i x')_i from `from` (d, near the surface: projected first)
  /// along `direction` (d; its tangential part counts, of any length > 0) for arc length `length` (negative: the
  /// other way; 0: the start). Gauss collocation of order 16 with steps as long as the surface allows.
  ///
  /// Status: ok; left_domain where the surface's domain ends or F is no longer finite; rank_deficient where J loses
  /// rank; not_converged at a crease, or when max_steps are used up. Then `point` and `length` tell where it stopped.
  ///
  /// Throws InvalidArgument for a wrong shape, a number that is not finite, a point from which no surface point is
  /// found, a direction without tangential part; SingularPoint when the start has no tangent space; Cancelled.
  /// Properties the tests check: exp from the end along -direction returns to the start; the result does not depend on
  /// the scale of F or of `direction`; exp_p(s v) for s = s1 + s2 equals going s1, then s2.
  [[nodiscard]] ExponentialResult trace(const VectorIn& from, const VectorIn& direction, double length,
                                        const Context& context = {});

  class Backend;

 private:
  std::unique_ptr<Backend> backend_;
};

/// The same once.
[[nodiscard]] ExponentialResult exponential_map(const Surface& surface, const VectorIn& from, const VectorIn& direction,
                                                double length, const ExponentialOptions& options = {},
                                                const Context& context = {});

/// Where a geodesic between two points lands when it is followed as an initial-value problem instead.
struct Verification {
  Status status = Status::not_converged;  ///< of the ray; unless it is ok, the rest is for the ray as far as it came
  double miss = std::numeric_limits<double>::quiet_NaN();  ///< distance from where it lands to the end, model units
  /// The part of the way to the end that lies along the ray there, model units: the error of the length, seen from the
  /// ray, if it had been aimed well. What is left of `miss` lies across: an error of the start direction, times how
  /// rays spread. The length of a path is wrong by its square only.
  double miss_along = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::infinity();  ///< of the landing point: `ExponentialResult::error`
  double amplification = 1;                                ///< `ExponentialResult::amplification`
};

/// Integrates the geodesic equation from `from` (d, on the surface) along `direction` (d) for `length` (model units) by
/// `exponential_map`, which shares nothing with the methods that find paths but F, and compares with `to` (d). Throws
/// what `exponential_map` throws.
[[nodiscard]] Verification verify_geodesic(const Surface& surface, const VectorIn& from, const VectorIn& direction,
                                           double length, const VectorIn& to, const Context& context = {});

/// How neighbours of a geodesic from 1 to 2 on a 2-surface spread (Karney 2013, sec. 3): solutions of j'' + K j = 0, K
/// the Gaussian curvature along it.
struct GeodesicScales {
  Status status = Status::ok;  ///< rank_deficient where J loses rank on the way or the ray cannot be followed, else ok
  double m12 = 0;              ///< reduced length, model units: j at 2 with (j, j') = (0, 1) at 1
  double M12 = 1;              ///< geodesic scale: j at 2 with (1, 0) at 1
  double M21 = 1;              ///< the same from 2 to 1; also j' at 2 with (0, 1) at 1
  double error = 0;            ///< estimated, of m12 / length, M12 and M21
};

/// Of the geodesic that leaves `from` (d, on the surface) along the unit tangent `direction` (d) for `length` >= 0. Any
/// d with d - k = 2; throws InvalidArgument otherwise. Gauss collocation of order 16 for the ray and the fields, steps
/// halved until nothing changes. Checked: M12 M21 - m12 M12' = 1; the references to 1e-10 of the largest of the three.
[[nodiscard]] GeodesicScales geodesic_scales(const Surface& surface, const VectorIn& from, const VectorIn& direction,
                                             double length);

/// Vectors that were carried along a curve.
struct CarriedVectors {
  Status status = Status::ok;  ///< rank_deficient where J loses rank on the way, else ok
  Points start;                ///< d x m: the tangential parts of what was given, at the start of the curve
  Points end;                  ///< d x m: the same carried to its end, tangent there
  double error = 0;            ///< estimated, radians: of the directions in `end`, for this curve
};

/// Carries `vectors` (d x m, at the start; their tangential parts count) parallel along a curve on the surface, a
/// geodesic or not: V' = -J^+ (x' . H_i V)_i, the tangential part of V' being zero. By Gauss collocation of order 16,
/// its steps halved until the result no longer changes (1e-14 and less where the curve is smooth within its elements).
/// Lengths and angles between the vectors are kept to rounding. Throws InvalidArgument for a wrong shape, an empty
/// curve or a number that is not finite. Properties the tests check: linear; back along the reversed curve it is the
/// identity; the tangent of a geodesic goes to its tangent; holonomy round a geodesic triangle of the sphere is its
/// angle excess.
[[nodiscard]] CarriedVectors parallel_transport(const Surface& surface, const SpectralCurve& curve,
                                                const PointsIn& vectors);

}  // namespace taut
