#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::detail {

/// A zero of f between a and b, where f has opposite signs (or b's may be just short of zero: then near b). Secants,
/// with the Illinois rule and a bisection where they stall; to rounding, or where f itself is rounding.
template <class Function>
double find_zero(Function&& f, double a, double f_a, double b, double f_b) {
  constexpr int kMostSteps = 60;
  for (int step = 0; step < kMostSteps && f_b != 0; ++step) {
    // Without a change of sign these are plain secants towards a zero just beyond b.
    const bool straddles = (f_a > 0) != (f_b > 0);
    double t = b - f_b * (b - a) / (f_b - f_a);
    if (!std::isfinite(t)) break;
    // Every sixth step halves the interval, so that it shrinks whatever f does.
    if (straddles && (step % 6 == 5 || !(t > std::min(a, b) && t < std::max(a, b)))) t = a + (b - a) / 2;
    const double step_size = std::abs(t - b);
    const double f_t = f(t);
    if (!std::isfinite(f_t)) break;
    if ((f_t > 0) != (f_b > 0)) {
      a = b;
      f_a = f_b;
    } else if (straddles) {
      // Illinois: the end that stays would hold the secant back; half its value moves the next one past the zero.
      f_a /= 2;
    } else {
      a = b;
      f_a = f_b;
    }
    b = t;
    f_b = f_t;
    if (step_size <= 2 * std::numeric_limits<double>::epsilon() * std::abs(t)) break;
    // A few secants reach a zero that is near; one that is not must not be run after.
    if (!straddles && step > 2) break;
  }
  return b;
}

}  // namespace taut::detail
