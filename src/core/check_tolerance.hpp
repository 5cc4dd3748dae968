#pragma once

namespace taut::detail {

/// What may be asked of a length, relative: rounding alone makes some 1e-15, and below 1e-13 no estimate can tell.
inline constexpr double kLeastTolerance = 1e-13;
inline constexpr double kMostTolerance = 1e-3;

/// Throws InvalidArgument for any other relative length tolerance.
void check_tolerance(double tolerance);

}  // namespace taut::detail
