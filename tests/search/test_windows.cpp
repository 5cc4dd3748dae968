// Surfaces that go on without end: cells are made in a box around the two points, but the shortest path may leave it.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

/// The cylinder x = a z^2 unrolls: its points are (arc length of the parabola up to z, y).
struct ParabolicCylinder {
  double a;

  [[nodiscard]] Surface surface() const { return parse_surface("x=" + std::to_string(a) + "*z^2"); }
  [[nodiscard]] Vector point(double y, double z) const { return Eigen::Vector3d(a * z * z, y, z); }
  [[nodiscard]] double arc(double z) const {
    const double slope = 2 * a * z;
    return (slope * std::sqrt(1 + slope * slope) + std::asinh(slope)) / (4 * a);
  }
  [[nodiscard]] double distance(double y, double z, double v, double w) const {
    return std::hypot(arc(z) - arc(w), y - v);
  }
};

TEST(Endless, TheOnlyWayMayLeaveTheBoxAroundTheEnds) {
  // Beside each other on two sides of a fold, which lies far from both.
  for (const double a : {1.0, 3.0, 10.0}) {
    const ParabolicCylinder fold{a};
    const PathResult path = shortest_path(fold.surface(), fold.point(0, 1), fold.point(0.3, -1));
    ASSERT_EQ(path.status, Status::ok) << a << ": " << path.message;
    EXPECT_NEAR(path.length, fold.distance(0, 1, 0.3, -1), 1e-9 * path.length) << a;
    EXPECT_TRUE(path.message.empty()) << path.message;
  }
}

TEST(Endless, ManyPairsFindTheirWayOutOfTheBox) {
  const ParabolicCylinder fold{5};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> side(0.8, 1), along(0, 1);
  Points from(3, 40);
  Points to(3, 40);
  Vector expected(40);
  for (Index j = 0; j < 40; ++j) {
    const double y = along(random), z = side(random), v = along(random), w = -side(random);
    from.col(j) = fold.point(y, z);
    to.col(j) = fold.point(v, w);
    expected(j) = fold.distance(y, z, v, w);
  }
  const std::vector<PathResult> paths = PathSolver(fold.surface()).solve_pairs(from, to);
  for (Index j = 0; j < 40; ++j) {
    const PathResult& path = paths[static_cast<std::size_t>(j)];
    ASSERT_EQ(path.status, Status::ok) << path.message;
    EXPECT_NEAR(path.length, expected(j), 1e-9 * expected(j));
  }
}

// The box of an earlier pair holds these ends, too, but not the shortest way between them (7.51 in there).
TEST(Endless, AnEarlierPairLeavesNoTrace) {
  const Surface gyroid = parse_surface("sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)=0");
  const auto on = [&](double x, double y, double z) {
    return Vector(project_to_surface(gyroid, Eigen::Vector3d(x, y, z)).point);
  };
  PathSolver solver(gyroid);
  (void)solver.solve(on(-0.131414, 1.057607, -0.67219), on(2.539988, 2.004575, 0.637994));
  const Vector p = on(-2.73384246, -1.0692052, 2.52990784);
  const Vector q = on(-2.22807053, -0.41280844, -2.27729548);
  const PathResult again = solver.solve(p, q);
  const PathResult alone = shortest_path(gyroid, p, q);
  ASSERT_EQ(again.status, Status::ok);
  ASSERT_EQ(alone.status, Status::ok);
  EXPECT_NEAR(again.length, alone.length, 1e-9 * alone.length);
}

TEST(Endless, ComponentsAreSaidToBeApartAsFarAsWasLookedAt) {
  for (const char* formula : {"z^2=1", "z^2=1+x^2+y^2"}) {
    const PathResult path =
        shortest_path(parse_surface(formula, {.dim = 3}), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1));
    EXPECT_EQ(path.status, Status::disconnected) << formula;
    EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::apart) << path.message;
    EXPECT_TRUE(path.doubts.has(Doubt::beyond_window)) << path.message;
    EXPECT_TRUE(path.window.contains(path.from));
  }
  // Where the surface ends there is no such doubt.
  const PathResult bounded = shortest_path(parse_surface("(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0"),
                                           Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(4, 0, 1));
  EXPECT_EQ(bounded.status, Status::disconnected);
  EXPECT_EQ(bounded.obstacle.kind, Obstacle::Kind::apart) << bounded.message;
  EXPECT_FALSE(bounded.doubts.any()) << bounded.message;
}

}  // namespace
}  // namespace taut
