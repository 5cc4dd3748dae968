#pragma once

#include <cstdio>
#include <string>

#include "taut/core/types.hpp"

namespace taut::detail {

/// A number as messages show it: nine digits, "1e-12" rather than "0.000000".
inline std::string describe(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

/// A point as messages show it: "(1, 0, 0.5)"; a long one is cut.
inline std::string describe(const VectorIn& x) {
  constexpr Index kShown = 8;
  std::string text = "(";
  for (Index c = 0; c < x.size(); ++c) {
    if (c > 0) text += ", ";
    if (c == kShown && x.size() > kShown + 1) return text + "... " + std::to_string(x.size()) + " coordinates)";
    text += describe(x(c));
  }
  return text + ")";
}

}  // namespace taut::detail
