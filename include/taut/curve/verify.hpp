#pragma once

#include <limits>

#include "taut/core/context.hpp"
#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

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

}  // namespace taut
