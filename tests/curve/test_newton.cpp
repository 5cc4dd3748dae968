#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/newton.hpp"

namespace taut {
namespace {

using std::numbers::pi;

// A polyline from p to q over the given points between, each moved by noise of this size.
Points noisy(Points path, double size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (Index j = 1; j + 1 < path.cols(); ++j) {
    for (Index i = 0; i < path.rows(); ++i) path(i, j) += size * normal(random);
  }
  return path;
}

// Points on the great circle from e_1 towards e_2, by `angle` in all.
Points great_circle(Index d, double angle, Index segments) {
  Points path = Points::Zero(d, segments + 1);
  for (Index j = 0; j <= segments; ++j) {
    const double a = angle * static_cast<double>(j) / static_cast<double>(segments);
    path(0, j) = std::cos(a);
    path(1, j) = std::sin(a);
  }
  return path;
}

TEST(Newton, GreatCirclesInAnyDimension) {
  for (const Index d : {2, 3, 4, 5, 7, 10}) {
    for (const double angle : {0.3, 1.5, 2.9}) {
      const Points start = noisy(great_circle(d, angle, 24), d == 2 ? 0.0 : 0.05, 17);
      const NewtonResult path = correct_newton(test::unit_sphere(d), start, {.tolerance = 1e-12});
      EXPECT_EQ(path.status, Status::ok) << "d " << d << " angle " << angle << ": " << path.reason;
      EXPECT_NEAR(path.length, angle, 4e-15 * angle + 1e-15) << "d " << d;
      EXPECT_TRUE(path.locally_shortest);
      EXPECT_LE(std::abs(path.length - angle), path.length_error);
      EXPECT_LE(path.length_error, 1e-12 * angle);
    }
  }
}

// STYLE's triaxial pair: the curve z = 0 is a geodesic of length 1.3380387 but not shortest.
TEST(Newton, LeavesAGeodesicThatIsNotLocallyShortest) {
  const auto at = [](double degrees) {
    return Vector(Eigen::Vector3d(1.5 * std::cos(degrees * pi / 180), std::sin(degrees * pi / 180), 0));
  };
  Points start(3, 15);
  for (Index j = 0; j < 15; ++j) start.col(j) = at(20 - 5.0 * static_cast<double>(j));
  const Surface surface = test::ellipsoid(1.5, 1, 0.5);
  const NewtonResult shortest = correct_newton(surface, start, {.tolerance = 1e-12});
  EXPECT_EQ(shortest.status, Status::ok);
  EXPECT_TRUE(shortest.locally_shortest);
  EXPECT_NEAR(shortest.length, 1.3325034, 5e-8);

  const NewtonResult saddle = correct_newton(surface, start, {.tolerance = 1e-12, .leave_saddles = false});
  EXPECT_NEAR(saddle.length, 1.3380387, 5e-8);
  EXPECT_FALSE(saddle.locally_shortest);
  EXPECT_EQ(saddle.index, 1);
}

TEST(Newton, KeepsTheEndsAndReturnsDensePointsOnTheSurface) {
  const Surface surface = test::tangle_cube();
  Points start(3, 2);
  start.col(0) = Eigen::Vector3d(2.0, 0.5, 0.5);
  start.col(1) = Eigen::Vector3d(1.5, 1.5, -0.2);
  for (Index j = 0; j < 2; ++j) {  // onto the surface by Newton's method along the gradient
    for (int step = 0; step < 30; ++step) {
      const Vector g = surface.jacobian(start.col(j));
      start.col(j) -= surface.value(start.col(j))(0) / g.squaredNorm() * g;
    }
  }
  const NewtonResult path = correct_newton(surface, start);
  EXPECT_EQ(path.status, Status::ok) << path.reason;
  ASSERT_GE(path.points.cols(), 65);
  EXPECT_EQ(path.points.col(0), start.col(0));
  EXPECT_EQ(path.points.rightCols<1>(), start.rightCols<1>());
  const Points value = surface.value(path.points);
  const Points gradient = surface.jacobian(path.points);
  EXPECT_LT((value.row(0).array() / gradient.colwise().norm().array()).abs().maxCoeff(), 1e-13);
  EXPECT_LT(path.residual.surface, 1e-6);
}

TEST(Newton, EqualEndsAreAPathOfThatPoint) {
  Points start(3, 3);
  start.colwise() = Eigen::Vector3d(1, 0, 0);
  const NewtonResult path = correct_newton(test::unit_sphere(), start);
  EXPECT_EQ(path.status, Status::ok);
  EXPECT_EQ(path.length, 0);
  EXPECT_EQ(path.points.col(0), start.col(0));
}

TEST(Newton, RefusesWhatIsNoPath) {
  const Surface sphere = test::unit_sphere();
  Points start = great_circle(3, 1, 4);
  EXPECT_THROW((void)correct_newton(sphere, start.leftCols(1)), InvalidArgument);
  EXPECT_THROW((void)correct_newton(sphere, start.topRows(2)), InvalidArgument);
  EXPECT_THROW((void)correct_newton(sphere, start, {.tolerance = 0}), InvalidArgument);
  EXPECT_THROW((void)correct_newton(sphere, start, {.max_iterations = 0}), InvalidArgument);
  NewtonSolver solver(sphere);
  EXPECT_THROW((void)solver.refine(SpectralCurve()), InvalidArgument);
  EXPECT_THROW((void)solver.refine(SpectralCurve(1, {1.0}, Points::Zero(2, 2))), InvalidArgument);
  start(1, 2) = std::nan("");
  EXPECT_THROW((void)correct_newton(sphere, start), InvalidArgument);
}

}  // namespace
}  // namespace taut
