#include "taut/query/point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

double angle(const VectorIn& a, const VectorIn& b) {
  return std::atan2((a - b).norm() / 2, std::sqrt(std::max(0.0, 1 - (a - b).squaredNorm() / 4))) * 2;
}

/// No two points are nearer than the last cover, and it falls as 1 / sqrt(n): 4 pi >= n caps of half the cover.
TEST(FarthestPoints, SpreadOverTheSphere) {
  const Surface sphere = test::unit_sphere();
  constexpr Index kCount = 200;
  const FarthestPoints chosen = farthest_points(sphere, Eigen::Vector3d(1, 0, 0), kCount);
  ASSERT_EQ(chosen.points.cols(), kCount);
  ASSERT_EQ(chosen.cover.size(), static_cast<std::size_t>(kCount));
  EXPECT_LT((chosen.points.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
  double least = 10;
  for (Index i = 0; i < kCount; ++i) {
    for (Index j = 0; j < i; ++j) least = std::min(least, angle(chosen.points.col(i), chosen.points.col(j)));
  }
  EXPECT_GT(least, 0.97 * chosen.cover.back());
  // Between the best that discs can do and what a greedy choice guarantees (twice that).
  const double ideal = std::sqrt(8 * std::numbers::pi / (std::sqrt(3) * kCount));
  EXPECT_LT(least, ideal);
  EXPECT_GT(least, 0.7 * ideal);
  for (std::size_t k = 1; k < chosen.cover.size(); ++k) EXPECT_LE(chosen.cover[k], chosen.cover[k - 1] * (1 + 1e-12));
  EXPECT_NEAR(angle(chosen.points.col(0), chosen.points.col(1)), std::numbers::pi, 0.1);
}

TEST(FarthestPoints, WorkInFourDimensions) {
  const Surface sphere = test::unit_sphere(4);
  const FarthestPoints chosen = farthest_points(sphere, Vector::Unit(4, 0), 8);
  EXPECT_NEAR((chosen.points.col(1) + Vector::Unit(4, 0)).norm(), 0, 0.3);
}

TEST(FarthestPoints, RefuseWrongRequests) {
  const Surface sphere = test::unit_sphere();
  EXPECT_THROW((void)farthest_points(sphere, Eigen::Vector3d(1, 0, 0), 0), InvalidArgument);
  EXPECT_THROW((void)farthest_points(sphere, Vector::Zero(2), 3), InvalidArgument);
  EXPECT_THROW((void)farthest_points(test::unit_sphere(8), Vector::Unit(8, 0), 3), InvalidArgument);
}

}  // namespace
}  // namespace taut
