#pragma once

#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

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
