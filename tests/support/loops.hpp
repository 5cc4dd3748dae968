#pragma once

// Polylines and loops whose homotopy classes are known, on surfaces with closed forms.

#include <cmath>
#include <functional>
#include <numbers>

#include "taut/core/types.hpp"

namespace taut::test {

/// curve(t) at n + 1 places, t = 0 .. 1.
inline Points polyline(Index n, const std::function<Vector(double)>& curve) {
  Points points(curve(0).size(), n + 1);
  for (Index j = 0; j <= n; ++j) points.col(j) = curve(static_cast<double>(j) / static_cast<double>(n));
  return points;
}

/// The same as a loop: without the last place.
inline Points loop(Index n, const std::function<Vector(double)>& curve) { return polyline(n, curve).leftCols(n); }

/// On the torus of radii 1 and 0.4: u along, v round the tube (0 = outermost).
inline Vector on_torus(double u, double v) {
  const double rho = 1 + 0.4 * std::cos(v);
  return Eigen::Vector3d(rho * std::cos(u), rho * std::sin(u), 0.4 * std::sin(v));
}

/// On the cylinder x^2 + y^2 = 1.
inline Vector on_cylinder(double angle, double z) { return Eigen::Vector3d(std::cos(angle), std::sin(angle), z); }

/// On x1^2 + x2^2 = 1, x3^2 + x4^2 = 1/4.
inline Vector on_clifford(double u, double v) {
  return Eigen::Vector4d(std::cos(u), std::sin(u), std::cos(v) / 2, std::sin(v) / 2);
}

}  // namespace taut::test
