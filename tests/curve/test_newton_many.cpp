// Newton's method where tangent coordinates are too many to eliminate: conjugate gradients and Lanczos.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "curve/direct_system.hpp"
#include "curve/newton_backend.hpp"
#include "taut/curve/newton.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr unsigned kSeed = 7;

/// sum x_i^2 / a_i^2 = 1.
Surface ellipsoid(const Vector& axes) {
  std::string formula;
  for (Index i = 0; i < axes.size(); ++i) {
    formula += i > 0 ? "+x" : "x";
    formula += std::to_string(i + 1);
    formula += "^2/" + std::to_string(axes(i)) + "^2";
  }
  return parse_surface(formula + "=1");
}

/// The formula's axes: what std::to_string keeps of them.
Vector random_axes(Index dim, std::mt19937_64& random) {
  std::uniform_int_distribution<int> percent(50, 200);
  Vector axes(dim);
  for (double& a : axes) a = percent(random) / 100.0;
  return axes;
}

Vector random_unit(Index dim, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Vector x(dim);
  for (double& c : x) c = normal(random);
  return x.normalized();
}

/// A polyline on the great circle through p and q: `turn` radians from p.
Points arc(const Vector& p, const Vector& q, double turn) {
  const Vector side = (q - q.dot(p) * p).normalized();
  Points path(p.size(), 21);
  for (Index i = 0; i <= 20; ++i) {
    const double t = turn * static_cast<double>(i) / 20;
    path.col(i) = std::cos(t) * p + std::sin(t) * side;
  }
  return path;
}

TEST(NewtonMany, GreatCirclesToRoundingInUpToAThousandDimensions) {
  std::mt19937_64 random(kSeed);
  for (const Index dim : {12, 50, 1000}) {
    const Surface sphere = ellipsoid(Vector::Ones(dim));
    const Vector p = random_unit(dim, random);
    const Vector q = random_unit(dim, random);
    const double angle = std::acos(p.dot(q));
    Points path = arc(p, q, angle);
    path.col(20) = q;
    for (Index i = 1; i < 20; ++i) path.col(i) += 0.03 * random_unit(dim, random);
    for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-13}) {
      const NewtonResult result = correct_newton(sphere, path, {.tolerance = tolerance});
      ASSERT_EQ(result.status, Status::ok) << result.reason << ", d = " << dim << ", tolerance " << tolerance;
      EXPECT_LE(std::abs(result.length - angle), result.length_error + 4e-16);
      EXPECT_LE(result.length_error, tolerance * angle + 2e-14);
      EXPECT_TRUE(result.locally_shortest);
      EXPECT_EQ(result.points.col(0), p);
      EXPECT_EQ(result.points.rightCols<1>(), q);
    }
  }
}

TEST(NewtonMany, AgreesWithTheDirectSolver) {
  std::mt19937_64 random(kSeed);
  const Index dim = 24;
  for (int repeat = 0; repeat < 4; ++repeat) {
    const Surface surface = ellipsoid(random_axes(dim, random));
    Points path(dim, 12);
    const Vector a = random_unit(dim, random);
    const Vector b = random_unit(dim, random);
    for (Index i = 0; i < 12; ++i) {
      path.col(i) =
          project_to_surface(surface, (1 - static_cast<double>(i) / 11) * a + static_cast<double>(i) / 11 * b).point;
    }
    const NewtonOptions options{.tolerance = 1e-11};
    const NewtonResult iterative = correct_newton(surface, path, options);
    const NewtonResult direct =
        detail::make_newton_driver<detail::DirectSystem<Eigen::Dynamic, Eigen::Dynamic>>(surface, options)
            ->solve(path, {});
    ASSERT_EQ(iterative.status, Status::ok) << iterative.reason;
    ASSERT_EQ(direct.status, Status::ok) << direct.reason;
    EXPECT_NEAR(iterative.length, direct.length, iterative.length_error + direct.length_error);
    EXPECT_EQ(iterative.locally_shortest, direct.locally_shortest);
  }
}

// The long way round is a geodesic, and exactly symmetric: no gradient ever points away from it.
TEST(NewtonMany, FindsTheHiddenDirectionThatLeavesAGreatCircle) {
  std::mt19937_64 random(kSeed);
  const Index dim = 30;
  const Surface sphere = ellipsoid(Vector::Ones(dim));
  const Vector p = random_unit(dim, random);
  const Vector q = random_unit(dim, random);
  const double angle = std::acos(p.dot(q));
  Points path = arc(p, q, angle - 2 * std::numbers::pi);
  path.col(20) = q;
  const NewtonResult kept = correct_newton(sphere, path, {.tolerance = 1e-10, .leave_saddles = false});
  ASSERT_EQ(kept.status, Status::ok) << kept.reason;
  EXPECT_NEAR(kept.length, 2 * std::numbers::pi - angle, 1e-10);
  EXPECT_FALSE(kept.locally_shortest);
  EXPECT_GE(kept.index, 1);
  const NewtonResult left = correct_newton(sphere, path, {.tolerance = 1e-10});
  ASSERT_EQ(left.status, Status::ok) << left.reason;
  EXPECT_NEAR(left.length, angle, 1e-10);
  EXPECT_TRUE(left.locally_shortest);
}

// Half great circles turned about an axis that nearly joins the ends are all nearly as long and nearly geodesics: the
// energy is a valley with a level floor. Turned by half a turn it is exactly a saddle.
TEST(NewtonMany, NearlyAntipodalEndsFromATurnedHalfCircle) {
  std::mt19937_64 random(kSeed);
  for (const Index dim : {3, 4, 20, 50}) {
    const Surface sphere = ellipsoid(Vector::Ones(dim));
    for (const double gap : {1e-4, 1e-7, 1e-8, 1e-10, 1e-15}) {
      const Vector p = random_unit(dim, random);
      Vector side = random_unit(dim, random);
      side = (side - side.dot(p) * p).normalized();
      const Vector q = (std::sin(gap) * side - std::cos(gap) * p).normalized();
      const double angle = 2 * std::atan2((p - q).norm(), (p + q).norm());
      Vector other = random_unit(dim, random);
      other -= other.dot(p) * p + other.dot(side) * side;
      other.normalize();
      for (const double turn : {1.6, std::numbers::pi}) {
        Points path = arc(p, std::cos(turn) * side + std::sin(turn) * other, angle);
        path.col(20) = q;
        for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
          const NewtonResult result = correct_newton(sphere, path, {.tolerance = tolerance});
          ASSERT_EQ(result.status, Status::ok)
              << result.reason << ", d = " << dim << ", gap " << gap << ", turn " << turn << ", " << tolerance;
          EXPECT_LE(std::abs(result.length - angle), result.length_error + 2e-15)
              << dim << ", gap " << gap << ", turn " << turn << ", " << tolerance;
          EXPECT_LE(result.length_error, std::max(tolerance, 1e-11) * angle * 1.3)
              << dim << ", " << gap << ", " << turn;
        }
      }
    }
  }
}

TEST(NewtonMany, TheCertificateTurnsAtTheAntipode) {
  std::mt19937_64 random(kSeed);
  const Index dim = 40;
  const Surface sphere = ellipsoid(Vector::Ones(dim));
  const Vector p = random_unit(dim, random);
  const Vector side = random_unit(dim, random);
  for (const double turn : {0.5, 0.99, 0.9999, 1.0001, 1.01, 1.5, 2.5}) {
    const Points path = arc(p, side, turn * std::numbers::pi);
    const NewtonResult result = correct_newton(sphere, path, {.tolerance = 1e-10, .leave_saddles = false});
    ASSERT_EQ(result.status, Status::ok) << result.reason << " at " << turn;
    EXPECT_EQ(result.locally_shortest, turn < 1) << turn;
    EXPECT_EQ(result.index, static_cast<int>(turn) * (dim - 2)) << turn;
    ASSERT_EQ(result.conjugate_at.has_value(), turn > 1) << turn;
    if (turn > 1) {
      EXPECT_NEAR(*result.conjugate_at, std::numbers::pi, 1e-9) << turn;
    }
  }
}

// St(n, 2) with the Euclidean metric: moving the first column in the plane of itself and a vector normal to both
// columns is a great circle of the first column's sphere, which is totally geodesic.
TEST(NewtonMany, GreatCircleOfAStiefelManifold) {
  const int n = 12;
  std::string first, second, product;
  for (int i = 0; i < n; ++i) {
    const std::string a = std::to_string(2 * i + 1);
    const std::string b = std::to_string(2 * i + 2);
    first += "+x" + a + "^2";
    second += "+x" + b + "^2";
    product += "+x" + a + "*x" + b;
  }
  const Surface surface = parse_surface(first + "=1;" + product + ";" + second + "=1");
  Points path = Points::Zero(2 * n, 9);
  for (Index i = 0; i < 9; ++i) {
    const double t = 1.3 * static_cast<double>(i) / 8;
    path(0, i) = std::cos(t);
    path(4, i) = std::sin(t);
    path(3, i) = 1;
  }
  std::mt19937_64 random(kSeed);
  for (Index i = 1; i < 8; ++i) path.col(i) += 0.03 * random_unit(2 * n, random);
  const NewtonResult result = correct_newton(surface, path, {.tolerance = 1e-12});
  ASSERT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_NEAR(result.length, 1.3, 1e-12);
  EXPECT_TRUE(result.locally_shortest);
}

}  // namespace
}  // namespace taut
