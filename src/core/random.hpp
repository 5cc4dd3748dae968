#pragma once

#include <cmath>
#include <random>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Uniform in [0, 1): the distributions of the standard library differ between platforms, its generators do not.
inline double random_share(std::mt19937_64& random) { return std::ldexp(static_cast<double>(random() >> 11), -53); }

/// A unit vector, close to uniform in direction.
inline Vector random_direction(Index dim, std::mt19937_64& random) {
  Vector x(dim);
  for (double& c : x) {
    c = -6;
    for (int i = 0; i < 12; ++i) c += random_share(random);  // close to a normal distribution
  }
  return x.normalized();
}

}  // namespace taut::detail
