#pragma once

#include <algorithm>
#include <cmath>

#include "taut/core/types.hpp"

namespace taut::detail {

/// How much wider than the paths it is to hold such a box is: in their length, and in the coordinates' size, so that
/// cells can be told apart in it.
struct ShorterPathRules {
  double of_length = 1e-3;
  double of_coordinates = 1e-6;
};

/// A box around all curves from p to q (d each) that are no longer than `length`, and a little more: around the
/// ellipsoid with foci p and q.
[[nodiscard]] inline Box box_of_shorter_paths(const VectorIn& p, const VectorIn& q, double length) {
  constexpr ShorterPathRules kRules;
  const double between = (q - p).norm();
  const double major = length / 2;
  const double minor2 = std::max(0.0, major * major - between * between / 4);
  const Eigen::ArrayXd along2 = ((q - p) / std::max(between, 1e-300)).array().square();
  const double margin = kRules.of_length * length +
                        kRules.of_coordinates * std::max(p.lpNorm<Eigen::Infinity>(), q.lpNorm<Eigen::Infinity>());
  const Vector reach = (major * major * along2 + minor2 * (1 - along2)).sqrt() + margin;
  const Vector middle = (p + q) / 2;
  return {middle - reach, middle + reach};
}

}  // namespace taut::detail
