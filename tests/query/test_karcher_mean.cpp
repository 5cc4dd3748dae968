#include "taut/query/point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/query/tangent_maps.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(KarcherMean, OfTwoPointsDividesTheirGeodesic) {
  const Surface sphere = test::unit_sphere();
  const Points points = (Points(3, 2) << 1, 0, 0, 1, 0, 0).finished();
  const KarcherMean middle = karcher_mean(sphere, points);
  ASSERT_EQ(middle.status, Status::ok) << middle.message;
  EXPECT_LT((middle.point - Eigen::Vector3d(1, 1, 0).normalized()).norm(), 1e-9);
  EXPECT_NEAR(middle.variance, std::pow(std::numbers::pi / 4, 2), 1e-9);
  EXPECT_TRUE(middle.unique);
  const KarcherMean third = karcher_mean(sphere, points, Vector(Eigen::Vector2d(2, 1)));
  EXPECT_LT((third.point - Eigen::Vector3d(std::cos(std::numbers::pi / 6), 0.5, 0)).norm(), 1e-9);
}

/// The mean of the logs vanishes at the mean: on a torus, where nothing else tells it.
TEST(KarcherMean, HasNoMeanLog) {
  const Surface torus = test::torus(1, 0.4);
  const Points points = (Points(3, 3) << 1.4, 1.3, 1.2, 0, 0.4, 0.1, 0, 0.1, 0.35).finished();
  const KarcherMean mean = karcher_mean(torus, points);
  ASSERT_EQ(mean.status, Status::ok) << mean.message;
  PathSolver solver(torus);
  Vector sum = Vector::Zero(3);
  double variance = 0;
  for (Index j = 0; j < 3; ++j) {
    const LogMapResult log = log_map(solver, mean.point, points.col(j));
    sum += log.velocity() / 3;
    variance += log.length * log.length / 3;
  }
  EXPECT_LT(sum.norm(), 1e-8);
  EXPECT_NEAR(mean.variance, variance, 1e-9);
}

TEST(KarcherMean, SaysWhenItIsNotUnique) {
  const Points opposite = (Points(3, 2) << 1, -1, 0, 0, 0, 0).finished();
  const KarcherMean any = karcher_mean(test::unit_sphere(), opposite);
  EXPECT_EQ(any.status, Status::ok) << any.message;
  EXPECT_NEAR(any.variance, std::pow(std::numbers::pi / 2, 2), 1e-8);
  EXPECT_FALSE(any.unique);
  EXPECT_FALSE(any.others.empty());
}

TEST(KarcherMean, WorksInMoreDimensions) {
  const Surface sphere = test::unit_sphere(4);
  const Points points = Points::Identity(4, 3);
  const KarcherMean mean = karcher_mean(sphere, points);
  ASSERT_EQ(mean.status, Status::ok) << mean.message;
  EXPECT_LT((mean.point - Vector(Eigen::Vector4d(1, 1, 1, 0).normalized())).norm(), 1e-8);
}

TEST(KarcherMean, RefusesWrongRequests) {
  const Surface sphere = test::unit_sphere();
  const Points points = Points::Identity(3, 2);
  EXPECT_THROW((void)karcher_mean(sphere, Points(3, 0)), InvalidArgument);
  EXPECT_THROW((void)karcher_mean(sphere, points, Vector::Ones(3)), InvalidArgument);
  EXPECT_THROW((void)karcher_mean(sphere, points, Vector::Zero(2)), InvalidArgument);
  EXPECT_THROW((void)karcher_mean(sphere, points, -Vector::Ones(2)), InvalidArgument);
}

}  // namespace
}  // namespace taut
