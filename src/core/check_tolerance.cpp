#include "core/check_tolerance.hpp"

#include <fmt/format.h>

#include "taut/core/error.hpp"

namespace taut::detail {

void check_tolerance(double tolerance) {
  if (tolerance >= kLeastTolerance && tolerance <= kMostTolerance) return;
  throw InvalidArgument(
      fmt::format("tolerance is {:g}, must be in {:g} .. {:g}", tolerance, kLeastTolerance, kMostTolerance));
}

}  // namespace taut::detail
