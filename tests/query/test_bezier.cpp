#include "taut/query/bezier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/query/tangent_maps.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

/// De Casteljau with `between(a, b, t)` for straight lines.
template <class Between>
Vector de_casteljau(Points points, double t, Between between) {
  for (Index n = points.cols() - 1; n > 0; --n) {
    for (Index i = 0; i < n; ++i) points.col(i) = between(Vector(points.col(i)), Vector(points.col(i + 1)), t);
  }
  return points.col(0);
}

Vector on_great_circle(const Vector& a, const Vector& b, double t) {
  const double angle = 2 * std::atan2((b - a).norm(), (a + b).norm());
  return (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
}

TEST(Bezier, OnASphereIsMadeOfGreatCircles) {
  PathSolver solver(test::unit_sphere());
  Points controls(3, 4);
  controls << 1, 0.6, 0, 0, 0, 0.8, 0.8, 0.28, 0, 0, 0.6, 0.96;
  const BezierCurve curve = bezier_curve(solver, controls, 21);
  ASSERT_EQ(curve.status, Status::ok) << curve.message;
  EXPECT_TRUE(curve.unique);
  for (Index j = 0; j < 21; ++j) {
    EXPECT_LT((curve.points.col(j) - de_casteljau(controls, curve.parameter(j), on_great_circle)).norm(), 1e-10) << j;
  }
}

/// A cylinder unrolls to the plane, where the curve is the ordinary one.
TEST(Bezier, OnACylinderIsThatOfThePlane) {
  PathSolver solver(parse_surface("x^2+y^2=1", {.dim = 3}));
  Points flat(2, 4);
  flat << 0, 0.3, 1.4, 2.2, 0, 1, -0.5, 0.4;  // angle, height
  const auto rolled = [](const Vector& p) { return Eigen::Vector3d(std::cos(p(0)), std::sin(p(0)), p(1)); };
  Points controls(3, 4);
  for (Index i = 0; i < 4; ++i) controls.col(i) = rolled(flat.col(i));
  const BezierCurve curve = bezier_curve(solver, controls, 17);
  ASSERT_EQ(curve.status, Status::ok) << curve.message;
  const auto on_line = [](const Vector& a, const Vector& b, double t) { return Vector((1 - t) * a + t * b); };
  for (Index j = 0; j < 17; ++j) {
    const Vector p = de_casteljau(flat, curve.parameter(j), on_line);
    EXPECT_LT((curve.points.col(j) - rolled(p)).norm(), 1e-10) << j;
  }
}

/// The same curve backwards from the reversed control points, on a surface of no symmetry and in R^4.
TEST(Bezier, ReversedControlPointsGiveItBackwards) {
  const auto check = [](const Surface& surface, const Points& controls) {
    PathSolver solver(surface);
    const BezierCurve there = bezier_curve(solver, controls, 9);
    const BezierCurve back = bezier_curve(solver, controls.rowwise().reverse(), 9);
    ASSERT_EQ(there.status, Status::ok) << there.message;
    ASSERT_EQ(back.status, Status::ok) << back.message;
    EXPECT_TRUE(there.unique);
    EXPECT_LT((there.points - back.points.rowwise().reverse()).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_NEAR(there.length, back.length, 1e-8);
  };
  check(parse_surface("x^2+y^2/4+z^2/9+0.1*x*y*z=1"), (Points(3, 3) << 1, 0, -0.5, 0, 1.9, 1, 0, 0, 2).finished());
  check(parse_surface("x^2+y^2+2*z^2+3*w^2=1"),
        (Points(4, 3) << 1, 0.5, 0, 0, 0.8, 0.3, 0, 0, 0.6, 0, 0.2, 0.1).finished());
}

/// At its ends it goes in the direction of the first and last path, `degree` times as fast: c(h) = c(0) + h v + O(h^2).
TEST(Bezier, LeavesAlongTheFirstPath) {
  const Surface torus = test::torus(1, 0.4);
  PathSolver solver(torus);
  const Points controls = (Points(3, 4) << 1.4, 1.2, 1, 0.3, 0, 0.6, 0.9, 1.2, 0, 0.2, 0.4, 0.3).finished();
  const LogMapResult log = log_map(solver, controls.col(0), controls.col(1));
  std::vector<double> off;
  for (const Index n : {101, 201}) {
    const BezierCurve curve = bezier_curve(solver, controls, n);
    ASSERT_EQ(curve.status, Status::ok) << curve.message;
    const Vector secant = (curve.points.col(1) - curve.points.col(0)) * static_cast<double>(n - 1);
    off.push_back((secant - 3 * log.velocity()).norm());
  }
  EXPECT_LT(off[0], 0.2 * log.length);
  EXPECT_NEAR(off[0] / off[1], 2, 0.1);
}

/// Opposite points of a sphere are joined by a circle of shortest paths: none of their curves is the right one.
TEST(Bezier, SaysWhereControlPointsLieTooFarApart) {
  PathSolver solver(test::unit_sphere());
  const Points controls = (Points(3, 3) << 1, -1, 0, 0, 0, 1, 0, 0, 0).finished();
  const BezierCurve curve = bezier_curve(solver, controls, 9);
  EXPECT_FALSE(curve.unique);
  EXPECT_FALSE(curve.message.empty());
}

TEST(Bezier, KeepsPointsThatCoincide) {
  PathSolver solver(test::unit_sphere());
  const Points controls = (Points(3, 3) << 1, 1, 0, 0, 0, 1, 0, 0, 0).finished();
  const BezierCurve curve = bezier_curve(solver, controls, 11);
  ASSERT_EQ(curve.status, Status::ok) << curve.message;
  for (Index j = 0; j < 11; ++j) {  // along the great circle, as t^2
    const double angle = curve.parameter(j) * curve.parameter(j) * std::numbers::pi / 2;
    EXPECT_LT((curve.points.col(j) - Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).norm(), 1e-10) << j;
  }
}

TEST(Bezier, RefusesWrongShapes) {
  PathSolver solver(test::unit_sphere());
  EXPECT_THROW((void)bezier_curve(solver, Points::Zero(3, 1), 9), InvalidArgument);
  EXPECT_THROW((void)bezier_curve(solver, Points::Zero(2, 3), 9), InvalidArgument);
  EXPECT_THROW((void)bezier_curve(solver, Points::Identity(3, 3), 1), InvalidArgument);
}

}  // namespace
}  // namespace taut
