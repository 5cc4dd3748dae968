#pragma once

#include <Eigen/Core>

namespace taut::detail {

// The cubic B-splines that are not zero on [0, 1], by their coefficients c_{-1} .. c_2, and their derivatives. t may
// lie a little outside: the cubic goes on.

[[nodiscard]] inline Eigen::Array4d spline_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (4 + t * t * (3 * t - 6)) / 6, (4 + s * s * (3 * s - 6)) / 6, t * t * t / 6};
}

[[nodiscard]] inline Eigen::Array4d spline_slopes(double t) {
  const double s = 1 - t;
  return {-s * s / 2, t * (3 * t - 4) / 2, s * (4 - 3 * s) / 2, t * t / 2};
}

[[nodiscard]] inline Eigen::Array4d spline_curvatures(double t) { return {1 - t, 3 * t - 2, 1 - 3 * t, t}; }

}  // namespace taut::detail
