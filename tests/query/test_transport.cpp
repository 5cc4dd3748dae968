#include "taut/query/tangent_maps.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

/// A vector carried round a geodesic triangle of the sphere turns by its angle excess, which is its area.
TEST(Transport, HolonomyOfTheSphereIsTheAngleExcess) {
  PathSolver solver(test::unit_sphere());
  Points octant(3, 4);
  octant << 1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0;
  const Vector v = Eigen::Vector3d(0, 1, 0);
  const TransportResult round = transport_along(solver, octant, v);
  ASSERT_EQ(round.status, Status::ok) << round.message;
  EXPECT_LT((round.end - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_NEAR(round.length, 1.5 * pi, 1e-11);
  EXPECT_LT(round.error, 1e-12);

  const Eigen::Vector3d a = Eigen::Vector3d(1, 0.2, 0.3).normalized();
  const Eigen::Vector3d b = Eigen::Vector3d(0.4, 1, -0.2).normalized();
  const Eigen::Vector3d c = Eigen::Vector3d(-0.1, 0.3, 0.9).normalized();
  const double excess = 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));  // Van Oosterom 1983
  Points triangle(3, 4);
  triangle << a, b, c, a;
  const Eigen::Vector3d u = a.unitOrthogonal();
  const TransportResult turned = transport_along(solver, triangle, Vector(u));
  const Eigen::Vector3d end = turned.end.col(0);
  EXPECT_NEAR(std::atan2(a.dot(u.cross(end)), u.dot(end)), excess, 1e-12);
}

/// Lengths, angles between vectors, and the angle to the geodesic stay; back again it is the identity.
TEST(Transport, KeepsLengthsAndAngles) {
  for (const std::string formula :
       {"x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8", "x1^2+x2^2/2+x3^2+2*x4^2+x5^2=1", "x1^2+x2^2=1; x3^2+2*x4^2+x5^2=1"}) {
    const Surface surface = parse_surface(formula);
    const Index d = surface.dim();
    Points ends = Points::Constant(d, 2, 0.2);
    ends.col(0)(0) = d == 3 ? 2.2 : 1;
    ends.col(1)(1) = d == 3 ? 2.1 : 1;
    ends.col(1)(d - 1) = d == 3 ? 1.5 : 0.5;
    if (d == 3) ends.col(0).tail(2) << 1.5, 0.3;
    if (surface.codim() == 2) {
      ends.col(0) << 1, 0, 0.1, 0.6, 0.3;
      ends.col(1) << -0.2, 0.97, 0.7, -0.2, 0.5;
    }
    PathSolver solver(surface);
    const LogMapResult log = log_map(solver, ends.col(0), ends.col(1));
    ASSERT_EQ(log.status, Status::ok) << formula << log.message;
    Points vectors = Points::Random(d, 3);
    vectors.col(2) = log.direction;
    const TransportResult there = transport_along(solver, ends, vectors);
    ASSERT_EQ(there.status, Status::ok) << formula << there.message;
    EXPECT_LT((there.start.transpose() * there.start - there.end.transpose() * there.end).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((there.end.col(2) - log.arrival).norm(), 1e-10) << formula;
    const Points gradients = surface.jacobian(there.to);
    for (Index i = 0; i < surface.codim(); ++i) {
      const Vector gradient = gradients.col(0).segment(i * d, d);
      EXPECT_LT((gradient.normalized().transpose() * there.end).cwiseAbs().maxCoeff(), 1e-13) << formula;
    }
    Points back_ends(d, 2);
    back_ends << ends.col(1), ends.col(0);
    const TransportResult back = transport_along(solver, back_ends, there.end);
    EXPECT_LT((back.end - there.start).norm(), 1e-11) << formula;
  }
}

/// Along a circle of latitude a vector turns by 2 pi (1 - sin(latitude)); points along it give that to second order.
TEST(Transport, AlongACurveIsOfSecondOrder) {
  PathSolver solver(test::unit_sphere());
  const double latitude = 0.7;
  std::vector<double> errors;
  for (const int n : {20, 40, 80}) {
    Points circle(3, n + 1);
    for (int i = 0; i <= n; ++i) {
      const double t = 2 * pi * (i % n) / n;
      circle.col(i) << std::cos(latitude) * std::cos(t), std::cos(latitude) * std::sin(t), std::sin(latitude);
    }
    const Eigen::Vector3d north(-std::sin(latitude), 0, std::cos(latitude));
    const Eigen::Vector3d end = transport_along(solver, circle, Vector(north)).end.col(0);
    const Eigen::Vector3d at = circle.col(0);
    const double angle = std::atan2(at.dot(north.cross(end)), north.dot(end));
    errors.push_back(std::abs(std::remainder(angle - 2 * pi * (1 - std::sin(latitude)), 2 * pi)));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.1);
}

TEST(Transport, ToManyTargetsAgreesWithPaths) {
  const Surface surface = parse_surface("x^2+2y^2+4z^2=1");
  const Vector p = Eigen::Vector3d(1, 0, 0);
  Points targets(3, 3);
  targets << 0.2, 1, -0.5, 0.5, 0, -0.5, 0.3, 0, 0.25;
  Points vectors(3, 2);
  vectors << 0, 0.3, 1, -1, 0.5, 2;
  DistanceSolver field(surface, p);
  const Distances found = field.at(targets);
  PathSolver solver(surface);
  const Points many = transport_to_targets(surface, p, targets, found, vectors);
  for (Index j = 0; j < 3; ++j) {
    Points ends(3, 2);
    ends << p, targets.col(j);
    const TransportResult one = transport_along(solver, ends, vectors);
    EXPECT_LT((many.middleCols(2 * j, 2) - one.end).norm(), 1e-9);
  }
}

TEST(Transport, RefusesWrongRequests) {
  PathSolver solver(test::unit_sphere());
  const Points ends = Points::Identity(3, 2);
  EXPECT_THROW((void)transport_along(solver, ends, Points::Zero(2, 1)), InvalidArgument);
  EXPECT_THROW((void)transport_along(solver, ends.leftCols(1), Points::Zero(3, 1)), InvalidArgument);
  EXPECT_THROW((void)transport_along(solver, ends, Points::Constant(3, 1, std::nan(""))), InvalidArgument);
  EXPECT_EQ(transport_along(solver, ends, Points::Zero(3, 1)).end, Points(Points::Zero(3, 1)));
}

}  // namespace
}  // namespace taut
