#pragma once

// Point clouds on surfaces whose truth is known. Seeded; the same on every platform.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "taut/surface/point_cloud.hpp"

namespace taut::test {

/// splitmix64 as uniform numbers in (0, 1): the standard library's distributions differ between implementations.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
  }
  /// Standard normal (Box-Muller).
  double normal() {
    const double radius = std::sqrt(-2 * std::log((*this)()));
    return radius * std::cos(2 * std::numbers::pi * (*this)());
  }

 private:
  std::uint64_t state_;
};

inline PointCloud empty_cloud(Index d, Index n) { return {Points(d, n), Points(d, n), Eigen::Matrix3Xi(3, 0)}; }

/// Evenly spread on the ellipsoid with semi-axes `a`, the sphere's Fibonacci lattice stretched.
inline PointCloud ellipsoid_cloud(const Eigen::Vector3d& a, Index n) {
  PointCloud cloud = empty_cloud(3, n);
  for (Index i = 0; i < n; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n);
    const double turn = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    const Eigen::Vector3d u(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
    cloud.points.col(i) = u.cwiseProduct(a);
    cloud.normals.col(i) = u.cwiseQuotient(a).normalized();
  }
  return cloud;
}

/// Unit sphere in R^d, uniform at random (d = 3: evenly spread).
inline PointCloud sphere_cloud(Index d, Index n, std::uint64_t seed = 1) {
  if (d == 3) return ellipsoid_cloud(Eigen::Vector3d::Ones(), n);
  PointCloud cloud = empty_cloud(d, n);
  Uniform uniform(seed);
  for (Index i = 0; i < n; ++i) {
    for (Index axis = 0; axis < d; ++axis) cloud.points(axis, i) = uniform.normal();
    cloud.points.col(i).normalize();
  }
  cloud.normals = cloud.points;
  return cloud;
}

/// Torus of radii R and r, uniform by area at random.
inline PointCloud torus_cloud(Index n, double R = 1, double r = 0.4, std::uint64_t seed = 2) {
  PointCloud cloud = empty_cloud(3, n);
  Uniform uniform(seed);
  for (Index i = 0; i < n;) {
    const double u = 2 * std::numbers::pi * uniform();
    const double v = 2 * std::numbers::pi * uniform();
    if (uniform() * (R + r) > R + r * std::cos(v)) continue;
    cloud.normals.col(i) << std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v);
    cloud.points.col(i) << (R + r * std::cos(v)) * std::cos(u), (R + r * std::cos(v)) * std::sin(u), r * std::sin(v);
    ++i;
  }
  return cloud;
}

/// A tube of radius 0.3 around a trefoil knot, `along` by `around` points.
inline PointCloud knot_cloud(Index along, Index around) {
  PointCloud cloud = empty_cloud(3, along * around);
  const auto curve = [](double t) {
    return Eigen::Vector3d(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t));
  };
  for (Index i = 0; i < along; ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(along);
    const Eigen::Vector3d tangent = (curve(t + 1e-4) - curve(t - 1e-4)).normalized();
    const Eigen::Vector3d side = tangent.cross(Eigen::Vector3d(0, 0, 1)).normalized();
    const Eigen::Vector3d up = side.cross(tangent);
    for (Index j = 0; j < around; ++j) {
      const double v = 2 * std::numbers::pi * (static_cast<double>(j) + 0.5 * static_cast<double>(i % 2)) /
                       static_cast<double>(around);
      const Index k = i * around + j;
      cloud.normals.col(k) = std::cos(v) * side + std::sin(v) * up;
      cloud.points.col(k) = curve(t) + 0.3 * cloud.normals.col(k);
    }
  }
  return cloud;
}

/// The swiss roll t (cos t, ., sin t), 1.5 pi <= t <= 4.5 pi, width 21: its turns are 2 pi apart.
inline PointCloud roll_cloud(Index n, std::uint64_t seed = 3) {
  PointCloud cloud = empty_cloud(3, n);
  Uniform uniform(seed);
  for (Index i = 0; i < n; ++i) {
    const double t = 1.5 * std::numbers::pi * (1 + 2 * uniform());
    cloud.points.col(i) << t * std::cos(t), 21 * uniform(), t * std::sin(t);
    cloud.normals.col(i) =
        Eigen::Vector3d(std::sin(t) + t * std::cos(t), 0, t * std::sin(t) - std::cos(t)).normalized();
  }
  return cloud;
}

}  // namespace taut::test
