#include "taut/query/closed_geodesic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "support/loops.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;
using test::loop;
using test::on_clifford;
using test::on_cylinder;
using test::on_torus;

void expect_length(const ClosedGeodesic& found, double truth) {
  ASSERT_EQ(found.status, Status::ok) << found.message;
  EXPECT_FALSE(found.is_point);
  EXPECT_NEAR(found.length, truth, 1e-11 * truth);
  EXPECT_LE(std::abs(found.length - truth), found.length_error + 1e-14 * truth);
  EXPECT_LT(found.kink, 1e-5);
  EXPECT_EQ(found.points.col(0), found.points.rightCols(1));
}

double ellipse(double a, double b) {  // perimeter, a >= b
  return 4 * a * std::comp_ellint_2(std::sqrt(1 - b * b / (a * a)));
}

TEST(ClosedGeodesic, RoundACylinderAsOftenAsLaid) {
  const Surface cylinder = parse_surface("x^2+y^2=1", {.dim = 3});
  for (const int turns : {1, 2, -3}) {
    const ClosedGeodesic found =
        closed_geodesic(cylinder, loop(10 * std::abs(turns), [&](double t) {
                          const double angle = 2 * pi * turns * t;
                          return on_cylinder(angle, 0.3 * std::sin(angle) + 0.2 * std::cos(3 * angle));
                        }));
    expect_length(found, 2 * pi * std::abs(turns));
    EXPECT_EQ(found.index, 0);
    EXPECT_EQ(found.neutral, 1);
  }
}

TEST(ClosedGeodesic, InnerEquatorOfATorusIsAMinimum) {
  const Surface torus = test::torus();
  const auto wobbly = [](double t) {
    return on_torus(2 * pi * t, pi + 0.8 * std::sin(2 * pi * t) + 0.3 * std::cos(10 * pi * t));
  };
  const ClosedGeodesic found = closed_geodesic(torus, loop(30, wobbly));
  expect_length(found, 2 * pi * 0.6);
  EXPECT_EQ(found.index, 0);
  EXPECT_EQ(found.neutral, 0);
  EXPECT_TRUE(found.locally_shortest);
  // Written with its first point again; reversed; twice.
  expect_length(closed_geodesic(torus, test::polyline(30, wobbly)), 2 * pi * 0.6);
  expect_length(closed_geodesic(torus, loop(30, wobbly).rowwise().reverse()), 2 * pi * 0.6);
  expect_length(closed_geodesic(torus, loop(60, [&](double t) { return wobbly(2 * t); })), 4 * pi * 0.6);
  // A loop off the outer equator slides to the inner one.
  expect_length(
      closed_geodesic(torus, loop(30, [](double t) { return on_torus(2 * pi * t, 0.5 + 0.1 * std::sin(2 * pi * t)); })),
      2 * pi * 0.6);
}

TEST(ClosedGeodesic, OuterEquatorHasTheIndexOfItsJacobiOperator) {
  // (k / (R + r))^2 < K = 1 / (r (R + r)) for k = 0, 1, -1.
  const ClosedGeodesic found =
      closed_geodesic(test::torus(), loop(30, [](double t) { return on_torus(2 * pi * t, 0); }));
  expect_length(found, 2 * pi * 1.4);
  EXPECT_EQ(found.index, 3);
  EXPECT_FALSE(found.locally_shortest);
}

TEST(ClosedGeodesic, MeridianAndMirroredWindings) {
  const Surface torus = test::torus();
  for (const int turns : {1, 2}) {
    expect_length(closed_geodesic(
                      torus, loop(20 * turns,
                                  [&](double t) { return on_torus(0.5 * std::sin(2 * pi * t), 2 * pi * turns * t); })),
                  0.8 * pi * turns);
  }
  const ClosedGeodesic right =
      closed_geodesic(torus, loop(40, [](double t) { return on_torus(2 * pi * t, 2 * pi * t); }));
  const ClosedGeodesic left =
      closed_geodesic(torus, loop(40, [](double t) { return on_torus(-2 * pi * t, 2 * pi * t); }));
  ASSERT_EQ(right.status, Status::ok);
  EXPECT_NEAR(right.length, left.length, 1e-11);
}

TEST(ClosedGeodesic, WindingsOfTheFlatTorusInR4) {
  const Surface clifford = parse_surface("x1^2+x2^2=1; x3^2+x4^2=0.25");
  for (const auto& [m, n] : {std::pair{1, 1}, {2, -1}, {3, 2}, {0, 1}}) {
    const auto wound = [m = m, n = n](double t) {
      const double w = 0.3 * std::sin(2 * pi * t);
      return on_clifford(2 * pi * m * t + w, 2 * pi * n * t - w);
    };
    expect_length(closed_geodesic(clifford, loop(60, wound)), 2 * pi * std::hypot(m, 0.5 * n));
  }
}

TEST(ClosedGeodesic, WaistOfAHyperboloid) {
  const ClosedGeodesic found =
      closed_geodesic(parse_surface("x^2+y^2-z^2=1"), loop(30, [](double t) -> Vector {
                        const double z = 0.5 + 0.4 * std::sin(6 * pi * t);
                        const double rho = std::sqrt(1 + z * z);
                        return Eigen::Vector3d(rho * std::cos(2 * pi * t), rho * std::sin(2 * pi * t), z);
                      }));
  expect_length(found, 2 * pi);
  EXPECT_EQ(found.index, 0);
  EXPECT_EQ(found.neutral, 0);
}

TEST(ClosedGeodesic, PrincipalEllipsesHaveIndexOneTwoThree) {
  // Morse 1934: on an ellipsoid with axes nearly alike the principal ellipses have index 1, 2 and 3.
  const Surface ellipsoid = test::ellipsoid(1, 0.8, 0.5);
  const auto in_plane = [&](int without) {
    return closed_geodesic(ellipsoid, loop(30, [&](double t) {
                             const double c = std::cos(2 * pi * t);
                             const double s = std::sin(2 * pi * t);
                             const double off = 0.003 * std::sin(4 * pi * t);
                             Vector x(3);
                             if (without == 0) x << off, 0.8 * c, 0.5 * s;
                             if (without == 1) x << c, off, 0.5 * s;
                             if (without == 2) x << c, 0.8 * s, off;
                             return x;
                           }));
  };
  const ClosedGeodesic shortest = in_plane(0);
  const ClosedGeodesic middle = in_plane(1);
  const ClosedGeodesic longest = in_plane(2);
  expect_length(shortest, ellipse(0.8, 0.5));
  expect_length(middle, ellipse(1, 0.5));
  expect_length(longest, ellipse(1, 0.8));
  EXPECT_EQ(shortest.index, 1);
  EXPECT_EQ(middle.index, 2);
  EXPECT_EQ(longest.index, 3);
}

TEST(ClosedGeodesic, GreatCirclesInSeveralDimensions) {
  for (const Index d : {3, 4, 10}) {
    const ClosedGeodesic found = closed_geodesic(test::unit_sphere(d), loop(30, [&](double t) {
                                                   Vector x = Vector::Zero(d);
                                                   x(0) = std::cos(2 * pi * t);
                                                   x(1) = std::sin(2 * pi * t);
                                                   return x;
                                                 }));
    expect_length(found, 2 * pi);
    EXPECT_EQ(found.index, d - 2);
    EXPECT_EQ(found.neutral, 2 * (d - 2));
  }
}

TEST(ClosedGeodesic, OnACurveItIsTheCurve) {
  expect_length(
      closed_geodesic(
          parse_surface("x^2+y^2=1"),
          loop(12, [](double t) -> Vector { return Eigen::Vector2d(std::cos(2 * pi * t), std::sin(2 * pi * t)); })),
      2 * pi);
}

TEST(ClosedGeodesic, LoopsThatShrinkToAPointSaySo) {
  const auto on_sphere = [](double t) -> Vector {
    const double angle = 2 * pi * t;
    return Eigen::Vector3d(std::cos(angle), std::sin(angle),
                           0.3 * std::sin(3 * angle) + 0.1 * std::cos(2 * angle) + 0.05);
  };
  for (const ClosedGeodesic& found :
       {closed_geodesic(test::unit_sphere(3), loop(30, on_sphere)),
        closed_geodesic(
            test::torus(),
            loop(60, [](double t) { return on_torus(1 + std::sin(2 * pi * t), pi / 2 + 1 - std::cos(2 * pi * t)); })),
        closed_geodesic(test::unit_sphere(3), Eigen::Vector3d(0, 0, 1).replicate(1, 5))}) {
    EXPECT_EQ(found.status, Status::ok) << found.message;
    EXPECT_TRUE(found.is_point);
    EXPECT_EQ(found.length, 0);
    EXPECT_TRUE(found.is_point);
    EXPECT_EQ(found.points.cols(), 2);
  }
}

TEST(ClosedGeodesic, WhatHasNoAnswerEndsAndSaysWhy) {
  // A horn that has no waist, and a cone's apex: the loop slips off for ever, or into the singular point.
  const auto round = [](double rho, double z) {
    return loop(30, [=](double t) -> Vector {
      return Eigen::Vector3d(rho * std::cos(2 * pi * t), rho * std::sin(2 * pi * t), z);
    });
  };
  const ClosedGeodesic horn = closed_geodesic(parse_surface("(x^2+y^2)*(1+z^2)=1"), round(1 / std::sqrt(1.25), 0.5));
  EXPECT_EQ(horn.status, Status::not_converged);
  EXPECT_FALSE(horn.message.empty());
  const ClosedGeodesic cone = closed_geodesic(parse_surface("x^2+y^2=z^2"), round(1, 1));
  EXPECT_NE(cone.status, Status::ok);
  EXPECT_EQ(cone.obstacle.kind, Obstacle::Kind::contracts) << cone.message;
}

TEST(ClosedGeodesic, RefusesWhatIsNoLoop) {
  const Surface sphere = test::unit_sphere(3);
  EXPECT_THROW((void)closed_geodesic(sphere, Points::Ones(3, 2)), InvalidArgument);
  EXPECT_THROW((void)closed_geodesic(sphere, Points::Ones(2, 5)), InvalidArgument);
  EXPECT_THROW((void)closed_geodesic(sphere, Points::Ones(3, 5), {.method = CorrectionMethod::flow}), InvalidArgument);
  // Half a great circle: its end may be joined to its start either way.
  EXPECT_THROW(
      (void)closed_geodesic(
          sphere, test::polyline(
                      10, [](double t) -> Vector { return Eigen::Vector3d(std::cos(pi * t), std::sin(pi * t), 0); })),
      InvalidArgument);
}

}  // namespace
}  // namespace taut
