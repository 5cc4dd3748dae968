#include "search/border_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/surface.hpp"

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;

/// Rings of samples in the plane, from radius 1 to 3.
PointCloud rings() {
  std::vector<Eigen::Vector3d> points;
  constexpr double kSpacing = 0.1;
  for (int ring = 0; ring <= 20; ++ring) {
    const double radius = 1 + kSpacing * ring;
    const int count = static_cast<int>(2 * kPi * radius / kSpacing);
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * kPi * k / count;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  }
  PointCloud cloud;
  cloud.points.resize(3, static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) cloud.points.col(static_cast<Index>(i)) = points[i];
  cloud.normals = Eigen::Vector3d::UnitZ().replicate(1, cloud.points.cols());
  return cloud;
}

/// Round a hole of the samples: two tangents and an arc of the border, which is a circle within the samples' symmetry.
TEST(BorderSearch, GoesRoundAHoleOfAScan) {
  const Surface scan = make_surface(fit_surface(rings(), {.method = FitMethod::local}));
  double inside = 1;
  double outside = 0;
  for (int k = 0; k < 50; ++k) {
    const double middle = (inside + outside) / 2;
    (scan.inside_domain(Eigen::Vector3d(middle, 0, 0))(0) ? inside : outside) = middle;
  }
  const double radius = inside;
  EXPECT_GT(radius, 0.5);
  EXPECT_LT(radius, 0.95);
  const PathResult path = shortest_path(scan, Eigen::Vector3d(-2, 0, 0), Eigen::Vector3d(2, 0, 0));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  const double turn = kPi - 2 * std::acos(radius / 2);
  const double truth = 2 * std::sqrt(4 - radius * radius) + radius * turn;
  EXPECT_NEAR(path.length, truth, 1e-3);
  EXPECT_LT(path.length_error, 1e-4);
  EXPECT_FALSE(path.unique);
  double along = 0;
  for (const PathPiece& piece : path.pieces) along += piece.kind == PathPiece::Kind::border ? piece.length : 0;
  EXPECT_NEAR(along, radius * turn, 0.1);
  EXPECT_TRUE(scan.inside_domain(path.points, 1e-3).all());
}

}  // namespace
}  // namespace taut
