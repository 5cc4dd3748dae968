#pragma once

#include <cmath>
#include <limits>

namespace taut::detail {

/// base^exponent as formulas define it: like std::pow, but zero has no sign, and -infinity is negative like any other
/// negative base: it has no fractional powers. 0^0 = 1. NaN gives NaN.
inline double power_of(double base, double exponent) {
  if (std::isnan(base) || std::isnan(exponent)) return base + exponent;
  if (base < 0 && exponent != std::floor(exponent)) return std::numeric_limits<double>::quiet_NaN();
  return std::pow(base + 0.0, exponent);
}

}  // namespace taut::detail
