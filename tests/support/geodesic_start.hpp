#pragma once

// Start paths for corrections: a geodesic integrated crudely from its start direction, with noise on top.

#include <random>

#include "taut/surface/surface.hpp"

namespace taut::test {

/// x'' = -(v^T H v / |g|^2) g for one equation.
inline Vector geodesic_acceleration(const Surface& surface, const Vector& x, const Vector& v) {
  const Vector g = surface.jacobian(x);
  return -(v.dot(surface.hessian(x, Vector::Ones(1)) * v) / g.squaredNorm()) * g;
}

/// The geodesic of this length from p along v as segments + 1 points (classical Runge-Kutta, 8 steps a segment).
inline Points integrate_geodesic(const Surface& surface, Vector x, Vector v, double length, Index segments) {
  Points path(x.size(), segments + 1);
  path.col(0) = x;
  const double h = length / static_cast<double>(8 * segments);
  for (Index j = 1; j <= segments; ++j) {
    for (int step = 0; step < 8; ++step) {
      const Vector k1 = geodesic_acceleration(surface, x, v);
      const Vector k2 = geodesic_acceleration(surface, x + h / 2 * v, v + h / 2 * k1);
      const Vector k3 = geodesic_acceleration(surface, x + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2);
      const Vector k4 = geodesic_acceleration(surface, x + h * v + h * h / 2 * k2, v + h * k3);
      x += h * v + h * h / 6 * (k1 + k2 + k3);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    for (int step = 0; step < 3; ++step) {  // back onto the surface
      const Vector g = surface.jacobian(x);
      x -= surface.value(x)(0) / g.squaredNorm() * g;
    }
    const Vector n = Vector(surface.jacobian(x)).normalized();
    v = (v - n.dot(v) * n).normalized();
    path.col(j) = x;
  }
  return path;
}

/// The path with its inner points moved by normal noise of this standard deviation.
inline Points with_noise(Points path, double size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (Index j = 1; j + 1 < path.cols(); ++j) {
    for (Index i = 0; i < path.rows(); ++i) path(i, j) += size * normal(random);
  }
  return path;
}

}  // namespace taut::test
