// Paths on volumes, against the surfaces that were sampled.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/volumes.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/query/surface_summary.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

/// Errors of the length between two points of a formula's surface, on volumes of n and then of 2 n - 1 voxels a side.
template <class F>
double length_order(Index n, double half, const F& f, const char* formula, const Vector& p, const Vector& q) {
  const PathResult exact = shortest_path(parse_surface(formula), p, q, {.tolerance = 1e-12});
  const auto error = [&](Index voxels) {
    const Surface surface = volume_surface(test::sampled_volume(voxels, half, f), {.iso = 0});
    const PathResult result = shortest_path(surface, exact.from, exact.to);
    EXPECT_EQ(result.status, Status::ok) << result.message;
    return std::abs(result.length - exact.length);
  };
  const double fine = error(2 * n - 1);
  EXPECT_LT(fine, 1e-6 * exact.length);
  return std::log2(error(n) / fine);
}

TEST(VolumePaths, LengthsConvergeWithTheSplinesOrder) {
  const double sphere = length_order(
      25, 1.5, [](const Eigen::Vector3d& x) { return x.norm() - 1; }, "sqrt(x^2+y^2+z^2)=1", Eigen::Vector3d(1, 0, 0),
      Eigen::Vector3d(-0.6, 0.64, 0.48));
  EXPECT_GT(sphere, 3.3);
  const double ellipsoid = length_order(
      19, 1.5, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(x(0), x(1) / 0.8, 2 * x(2)).norm() - 1; },
      "sqrt(x^2+y^2/0.64+4z^2)=1", Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-0.6, 0.5, 0.3));
  EXPECT_GT(ellipsoid, 3.3);
  const double torus = length_order(
      37, 1.7, [](const Eigen::Vector3d& x) { return std::hypot(std::hypot(x(0), x(1)) - 1, x(2)) - 0.4; },
      "sqrt((sqrt(x^2+y^2)-1)^2+z^2)=0.4", Eigen::Vector3d(1.4, 0, 0), Eigen::Vector3d(-0.6, 0.5, 0.3));
  EXPECT_GT(torus, 3.3);
}

TEST(VolumePaths, MeshOfATorusVolumeHasGenusOne) {
  const Surface torus = volume_surface(
      test::sampled_volume(33, 1.7,
                           [](const Eigen::Vector3d& x) { return std::hypot(std::hypot(x(0), x(1)) - 1, x(2)) - 0.4; }),
      {.iso = 0});
  const SurfaceMesh mesh = display_mesh(torus);
  // Closed triangles: three half edges each.
  const Index euler = mesh.vertices.cols() - 3 * mesh.faces.cols() / 2 + mesh.faces.cols();
  EXPECT_EQ(euler, 0);
  const SurfaceSummary summary = summarise(torus);
  EXPECT_EQ(summary.kind, "volume");
  EXPECT_EQ(summary.components.size(), 1U);
}

}  // namespace
}  // namespace taut
