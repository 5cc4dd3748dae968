#include "taut/query/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "support/loops.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;
using test::on_clifford;
using test::on_cylinder;
using test::on_torus;
using test::polyline;

Surface cylinder() { return parse_surface("x^2+y^2=1", {.dim = 3}); }

TEST(ClassPath, KeepsItsTurnsRoundACylinder) {
  constexpr unsigned kSeed = 5;
  for (const double turns : {0.0, 0.75, 1.0, 2.0, 5.0, 12.0, -2.0}) {
    for (const double noise : {0.0, 0.05}) {
      std::mt19937 random(kSeed);
      std::normal_distribution<double> normal;
      const double angle = 2 * pi * turns + 0.7;
      const auto n = static_cast<Index>(8 + 12 * std::abs(turns));
      Points start = polyline(n, [&](double t) { return on_cylinder(angle * t, 2 * t * t); });
      for (Index j = 1; j < n; ++j) {
        for (double& c : start.col(j)) c += noise * normal(random);
      }
      const PathResult path = path_in_class(cylinder(), start);
      ASSERT_EQ(path.status, Status::ok) << turns << " turns, seed " << kSeed << ": " << path.message;
      EXPECT_NEAR(path.length, std::hypot(angle, 2), 1e-10) << turns << " turns, seed " << kSeed;
      EXPECT_LE(std::abs(path.length - std::hypot(angle, 2)), path.length_error + 1e-13);
      EXPECT_EQ(path.points.col(0), path.from);
      EXPECT_EQ(path.points.rightCols(1), path.to);
    }
  }
}

TEST(ClassPath, FlowKeepsThemToo) {
  const Points start = polyline(40, [](double t) { return on_cylinder(5 * pi * t, 2 * t * t); });
  const PathResult path = path_in_class(cylinder(), start, {.method = CorrectionMethod::flow});
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, std::hypot(5 * pi, 2), 5e-4);
  EXPECT_LE(std::abs(path.length - std::hypot(5 * pi, 2)), path.length_error);
}

TEST(ClassPath, StaysWoundRoundATorus) {
  // Twice round the tube and back to the start; three times round the hole.
  const Points tube = polyline(30, [](double t) { return on_torus(0.3 * std::sin(6 * t) * t * (1 - t), 4 * pi * t); });
  EXPECT_NEAR(path_in_class(test::torus(), tube).length, 4 * pi * 0.4, 1e-10);
  const Points hole = polyline(60, [](double t) { return on_torus(6 * pi * t, pi + 0.8 * std::sin(2 * pi * t)); });
  EXPECT_NEAR(path_in_class(test::torus(), hole).length, 6 * pi * 0.6, 1e-10);
}

TEST(ClassPath, PassesAHoleSmallerThanACellOnTheSideItWasLaid) {
  // A flat plate with a hole of radius 0.1, cells of 0.12: normals are the same on both sides of the hole.
  const Surface plate = parse_surface("((sqrt(x^2+y^2)-1)/0.9)^2+(z/0.1)^2=1");
  const auto past = [&](double side, double far) {
    const Points start = polyline(80, [&](double t) -> Vector {
      const double x = 1 - 2 * t;
      const double y = side * far * std::sin(pi * t) + 0.03 * t;
      const double v = (std::hypot(x, y) - 1) / 0.9;
      return Eigen::Vector3d(x, y, 0.1 * std::sqrt(std::max(0.0, 1 - v * v)));
    });
    const PathResult path = path_in_class(plate, start);
    EXPECT_EQ(path.status, Status::ok) << path.message;
    EXPECT_GT(side * path.points(1, path.points.cols() / 2), 0.09);
    return path.length;
  };
  const double left = past(1, 0.15);
  const double right = past(-1, 0.15);
  EXPECT_GT(right, left + 1e-3);
  EXPECT_NEAR(past(1, 1.2), left, 1e-9);
  EXPECT_NEAR(past(-1, 1.2), right, 1e-9);
}

TEST(ClassPath, ManyDimensionsAndEquations) {
  const Surface clifford = parse_surface("x1^2+x2^2=1; x3^2+x4^2=0.25");
  const Points start = polyline(50, [](double t) { return on_clifford(6 * pi * t * t, (4 * pi + 1) * t); });
  EXPECT_NEAR(path_in_class(clifford, start).length, std::hypot(6 * pi, (4 * pi + 1) / 2), 1e-10);
  const Points arc = polyline(20, [](double t) {
    Vector x = Vector::Zero(30);
    x(0) = std::cos(2 * t);
    x(1) = std::sin(2 * t);
    x(7) = 0.1 * std::sin(2 * pi * t);
    return x;
  });
  EXPECT_NEAR(path_in_class(test::unit_sphere(30), arc).length, 2, 1e-10);
}

TEST(ClassPath, ReversedAndMirroredAreAsLong) {
  const Surface torus = test::torus();
  const Points there = polyline(40, [](double t) { return on_torus(2 * pi * t, 0.3 + 2 * pi * t * t); });
  const double length = path_in_class(torus, there).length;
  EXPECT_NEAR(path_in_class(torus, there.rowwise().reverse()).length, length, 1e-10 * length);
  Points mirrored = there;
  mirrored.row(2) *= -1;
  EXPECT_NEAR(path_in_class(torus, mirrored).length, length, 1e-10 * length);
}

TEST(ClassPath, TheLongWayRoundASphereIsNoClassOfItsOwn) {
  const Points start = polyline(30, [](double t) -> Vector {
    return Eigen::Vector3d(std::cos(1.5 * pi * t), std::sin(1.5 * pi * t), 0.3 * std::sin(pi * t));
  });
  EXPECT_NEAR(path_in_class(test::unit_sphere(3), start).length, pi / 2, 1e-10);
}

TEST(ClassPath, AReturningPolylineThatComesUndoneIsAPoint) {
  const Points start =
      polyline(60, [](double t) { return on_torus(1 + std::sin(2 * pi * t), pi / 2 + 1 - std::cos(2 * pi * t)); });
  const PathResult path = path_in_class(test::torus(), start);
  EXPECT_EQ(path.status, Status::ok) << path.message;
  EXPECT_LT(path.length, 1e-12);
  EXPECT_EQ(path.points.cols(), 2);
  const PathResult still = path_in_class(test::unit_sphere(3), Eigen::Vector3d(1, 0, 0).replicate(1, 4));
  EXPECT_EQ(still.status, Status::ok);
  EXPECT_EQ(still.length, 0);
}

TEST(ClassPath, NamesThePointsBetweenWhichTheClassIsNotPlain) {
  Points coarse = polyline(20, [](double t) { return on_cylinder(2 * pi * t, t); });
  coarse.col(5) = on_cylinder(2 * pi * 0.25 + pi, 0.25);
  try {
    (void)path_in_class(cylinder(), coarse);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("points 5 and 6"), std::string::npos) << error.what();
  }
  // Four points a turn are plain, three are not.
  EXPECT_NO_THROW((void)path_in_class(cylinder(), polyline(8, [](double t) { return on_cylinder(4 * pi * t, t); })));
  EXPECT_THROW((void)path_in_class(cylinder(), polyline(6, [](double t) { return on_cylinder(4 * pi * t, t); })),
               InvalidArgument);
  // From one sheet to another there is no way at all.
  Points across(3, 2);
  across << 1, 5, 0, 0, 0, 0;
  EXPECT_THROW((void)path_in_class(parse_surface("(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0"), across), InvalidArgument);
}

TEST(ClassPath, RefusesWhatIsNoPolyline) {
  const Surface sphere = test::unit_sphere(3);
  EXPECT_THROW((void)path_in_class(sphere, Points::Ones(3, 1)), InvalidArgument);
  EXPECT_THROW((void)path_in_class(sphere, Points::Ones(2, 3)), InvalidArgument);
  Points points = Points::Ones(3, 4);
  points(1, 2) = std::nan("");
  EXPECT_THROW((void)path_in_class(sphere, points), InvalidArgument);
  points(1, 2) = 900;
  EXPECT_THROW((void)path_in_class(sphere, points), InvalidArgument);
  EXPECT_THROW((void)path_in_class(sphere, Points::Ones(3, 2), {.method = CorrectionMethod::grid}), InvalidArgument);
  EXPECT_THROW((void)path_in_class(sphere, Points::Ones(3, 2), {.tolerance = 1}), InvalidArgument);
}

}  // namespace
}  // namespace taut
