// Closed forms beside those of test_edges and test_borders: shapes whose shortest paths a ruler and a compass give.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;

PathResult path(const std::string& formula, const std::vector<std::string>& domain, const Eigen::Vector3d& p,
                const Eigen::Vector3d& q) {
  FormulaOptions options;
  options.dim = 3;
  options.domain = domain;
  return shortest_path(parse_surface(formula, options), p, q);
}

void expect_length(const PathResult& found, double length) {
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_NEAR(found.length, length, 1e-11 * length);
}

// Out of the bore and down the sphere, in one plane.
TEST(EdgeTruth, BoredSphere) {
  const double polar = kPi / 3;
  expect_length(path("max(x^2+y^2+z^2-4, 1-x^2-y^2)", {}, {1, 0, 0}, {2 * std::sin(polar), 0, 2 * std::cos(polar)}),
                std::sqrt(3.0) + 2 * (polar - kPi / 6));
}

// A capsule is smooth, with curvature that jumps where its caps begin; a cylinder with flat caps has rims there.
TEST(EdgeTruth, CapsuleAgainstACylinderWithCaps) {
  const std::string capsule = "sqrt(x^2+y^2+max(abs(z)-1,0)^2)=1";
  expect_length(path(capsule, {}, {1, 0, 0.5}, {0, 0, 2}), 0.5 + kPi / 2);
  expect_length(path("max(x^2+y^2-1, abs(z)-1)", {}, {1, 0, 0.5}, {0, 0, 1}), 0.5 + 1);
  // Aslant: over the point of the seam at azimuth a that makes the sum of helix and great circle least.
  const double polar = 1.0;
  const double azimuth = 1.2;
  const auto length = [&](double a) { return std::hypot(a, 1.0) + std::acos(std::sin(polar) * std::cos(azimuth - a)); };
  double low = 0;
  double high = azimuth;
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3;
    (length(low + third) < length(high - third) ? high : low) =
        length(low + third) < length(high - third) ? high - third : low + third;
  }
  expect_length(path(capsule, {}, {1, 0, 0},
                     {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), 1 + std::cos(polar)}),
                length((low + high) / 2));
}

// Tangent, arc, the straight line over both discs, arc, tangent.
TEST(EdgeTruth, PlaneWithTwoHoles) {
  const PathResult found = path("z=0", {"(x+1.5)^2+y^2>=1", "(x-1.5)^2+y^2>=1"}, {-4, 0, 0}, {4, 0, 0});
  expect_length(found, 2 * std::sqrt(5.25) + 2 * std::asin(0.4) + 3);
  EXPECT_FALSE(found.unique);  // above them and below
}

// A corridor of discs that reach through its walls on alternate sides: under the first, over the second, under the
// third, with inner tangents from one to the next.
TEST(EdgeTruth, CorridorOfDiscs) {
  std::vector<std::string> domain;
  for (const char* disc : {"(x+3)^2+(y-0.5)^2>=1", "x^2+(y+0.5)^2>=1", "(x-3)^2+(y-0.5)^2>=1", "y<=1", "y>=-1"}) {
    domain.emplace_back(disc);
  }
  const double first = std::sqrt(9.25 - 1);                // tangent from the end
  const double between = std::sqrt(10.0 - 4);              // inner tangent of discs that are (3, 1) apart
  const double slope = std::atan2(1.0, 3.0);               // of the line between neighbours
  const double turn = std::acos(2 / std::sqrt(10.0));      // between that line and the radius to the tangent
  const double end_turn = std::acos(1 / std::sqrt(9.25));  // the same for the end
  const double end_slope = std::atan2(0.5, 3.0);
  // Angles of the touching points of the first disc, about its centre.
  const double begin = kPi + end_slope + end_turn;
  const double leave = 2 * kPi - slope - turn;
  // Of the second: both of its tangents are inner ones.
  const double middle = kPi - 2 * (slope + turn);
  expect_length(path("z=0", domain, {-6, 0, 0}, {6, 0, 0}), 2 * first + 2 * between + 2 * (leave - begin) + middle);
}

// The half plane y >= 0 with half a disc cut out of it.
TEST(EdgeTruth, ABayInAHalfPlane) {
  const PathResult found = path("z=0", {"y>=0", "x^2+y^2>=1"}, {-2, 0.5, 0}, {2, 0.5, 0});
  const double away = std::sqrt(4.25);
  expect_length(found, 2 * std::sqrt(3.25) + kPi - 2 * std::atan(0.25) - 2 * std::acos(1 / away));
  EXPECT_TRUE(found.unique);
}

// Next to a wall across the tube the way leads once round the torus, along its inner equator.
TEST(EdgeTruth, TorusWithAWall) {
  const double a = 0.5;
  expect_length(path("(sqrt(x^2+y^2)-2)^2+z^2=1", {"max(abs(y)-0.1,-x)>=0"}, {std::cos(a), std::sin(a), 0},
                     {std::cos(a), -std::sin(a), 0}),
                2 * kPi - 2 * a);
}

// Round a window, over its two upper corners: straight lines on the unrolled cylinder.
TEST(EdgeTruth, CylinderWithAWindow) {
  const double a = 1.2;
  const double half = std::asin(0.6);
  expect_length(path("x^2+y^2=1", {"max(abs(z)-0.5,abs(y)-0.6,-x)>=0"}, {std::cos(a), std::sin(a), 0.1},
                     {std::cos(a), -std::sin(a), 0.1}),
                2 * std::hypot(a - half, 0.4) + 2 * half);
}

// A fillet of radius r over an edge of 90 degrees takes (2 - pi/2) r out of the unfolded faces: the answer falls in
// proportion to r from that of sharp edges.
TEST(EdgeTruth, FilletsTendToSharpEdges) {
  for (const double r : {0.4, 0.1, 0.02}) {
    const auto side = [&](double half) { return std::to_string(half - r); };
    const std::string rounded = "sqrt(max(abs(x)-" + side(15) + ",0)^2+max(abs(y)-" + side(6) + ",0)^2+max(abs(z)-" +
                                side(6) + ",0)^2)=" + std::to_string(r);
    const double less = 2 * (2 - kPi / 2) * r;
    expect_length(path(rounded, {}, {-15, 0, 5}, {15, 0, -5}), std::hypot(32 - less, 24 - less));
  }
}

// Of 2026-12-01: the kink of max(1-x, x-3) at x = 2, in a box that plays no part there, hid all edges of the upper
// riser, and 4.35 was returned. Up the first riser, then over faces whose unfolding gives the truth (exact polyhedral
// distances of the mesh).
TEST(EdgeTruth, StairsOfBoxesWithKinksInTheirFaces) {
  const std::string stairs = "min(max(-x,x-3,-y,y-2,-z,z-1),max(1-x,x-3,-y,y-2,-z,z-2),max(2-x,x-3,-y,y-2,-z,z-3))";
  expect_length(
      path(stairs, {}, {0.16400583037382271, 2, 0.21166120042392308}, {2.4248672554128707, 1.2645479331308882, 3}),
      4.166760988659469);
  expect_length(
      path(stairs, {}, {2.5996484466484011, 0.056989597463230561, 3}, {0.4294313919467726, 2, 0.776168119040611}),
      4.539667176009818);
}

// Of 2026-12-01: the rim of the upper disc's hole pushes a path off the disc, but the wall inside pulls it. So no
// shortest path runs along the rim, though the two curvatures sum to less than zero: it cuts the rim twice.
TEST(EdgeTruth, LeavesARimOnTheSideThatPulls) {
  const std::string ring = "max((sqrt(x^2+y^2)-2)^2+z^2-0.5, abs(z)-0.4)";
  const Eigen::Vector3d p(0.42435476632975055, -2.3149004153483768, 0.4);
  const Eigen::Vector3d q(1.4801835212514307, 1.9910663719377044, 0.4);
  const double rim = 2 - std::sqrt(0.5 - 0.16);
  const auto tangent = [&](const Eigen::Vector3d& x) { return std::sqrt(x.head<2>().squaredNorm() - rim * rim); };
  const auto turn = [&](const Eigen::Vector3d& x) { return std::atan2(x.y(), x.x()); };
  const double arc = turn(q) - turn(p) - std::atan(tangent(p) / rim) - std::atan(tangent(q) / rim);
  const double along_the_rim = tangent(p) + tangent(q) + rim * arc;
  const PathResult there = path(ring, {}, p, q);
  EXPECT_LT(there.length, along_the_rim - 5e-3);
  expect_length(path(ring, {}, q, p), there.length);
}

}  // namespace
}  // namespace taut
