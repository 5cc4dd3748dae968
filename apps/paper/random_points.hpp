#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "taut/core/types.hpp"

namespace taut::paper {

/// Random numbers that are the same on every machine (the standard's engines are, its distributions are not).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Normal with mean 0 and deviation 1, by Box and Muller.
  double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::numbers::pi * uniform()); }
  /// Uniform on the unit hypersphere of R^d.
  Vector direction(Index dim) {
    Vector x(dim);
    for (double& entry : x) entry = normal();
    return x.normalized();
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace taut::paper
