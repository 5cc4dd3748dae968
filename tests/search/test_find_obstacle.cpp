#include "search/find_obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

Obstacle obstacle(const std::string& formula, const Vector& from, const Vector& to, const Vector& stopped_at,
                  double turn = 0) {
  detail::Tried tried{.cell = 0.01};
  tried.barrier = detail::Barrier{};
  tried.barrier->point = stopped_at;
  tried.barrier->turn = turn;
  return detail::find_obstacle(parse_surface(formula), from, to, tried);
}

TEST(FindObstacle, NamesTheSingularPoint) {
  const Obstacle cone = obstacle("x^2+y^2=z^2", Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(1, 0, -1),
                                 Eigen::Vector3d(0.0085, 0.0026, 0.0089));
  EXPECT_EQ(cone.kind, Obstacle::Kind::singular_between);
  EXPECT_LT(cone.place.norm(), 1e-9);
  const Obstacle touching = obstacle("(x^2+y^2+z^2-1)*((x-2)^2+y^2+z^2-1)", Eigen::Vector3d(-1, 0, 0),
                                     Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0.999, 0.04, 0.01));
  EXPECT_EQ(touching.kind, Obstacle::Kind::singular_between);
  EXPECT_LT((touching.place - Eigen::Vector3d(1, 0, 0)).norm(), 1e-4);
}

// A parallelogram of bars laid flat: the first equation's gradient is 1e-16 there, by rounding of sin(pi).
TEST(FindObstacle, NamesAnEndThatIsSingular) {
  const Surface bars = parse_surface("cos(x1)+2*cos(x1+x2)+cos(x1+x2+x3)=2; sin(x1)+2*sin(x1+x2)+sin(x1+x2+x3)=0");
  const double pi = std::numbers::pi;
  const PathResult path = shortest_path(bars, Eigen::Vector3d(0, 0, pi), Eigen::Vector3d(0.5, -0.5, pi + 0.5));
  EXPECT_EQ(path.status, Status::rank_deficient) << path.message;
  EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::singular_end) << path.message;
}

TEST(FindObstacle, TellsNearlyTouchingSheetsFromASingularPoint) {
  const Obstacle spheres = obstacle("(x^2+y^2+z^2-1)*((x-2.0001)^2+y^2+z^2-1)", Eigen::Vector3d(-1, 0, 0),
                                    Eigen::Vector3d(3.0001, 0, 0), Eigen::Vector3d(0.9934, 0.0797, 0.0827));
  EXPECT_EQ(spheres.kind, Obstacle::Kind::narrow_gap);
  EXPECT_NEAR(spheres.size, 1e-4, 1e-6);
  const Obstacle neck = obstacle("x^2+y^2=z^2+1e-8", Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(1, 0, -1),
                                 Eigen::Vector3d(0.008, 0.002, 0.008));
  EXPECT_EQ(neck.kind, Obstacle::Kind::narrow_gap);
  EXPECT_NEAR(neck.size, 2e-4, 2e-6);
}

TEST(FindObstacle, TellsACreaseFromAFoldedSheet) {
  const Vector from = Eigen::Vector3d(1, 0, 0);
  const Vector to = Eigen::Vector3d(-1, 0, 0);
  const Vector top = Eigen::Vector3d(0, 0, 1);
  const Obstacle crease = obstacle("x^2+y^2+z^2=1", from, to, top, 1.5);
  EXPECT_EQ(crease.kind, Obstacle::Kind::crease);
  EXPECT_EQ(crease.size, 1.5);
  EXPECT_EQ(crease.place, top);
  // Normals that are opposite to each other are those of two sheets.
  EXPECT_EQ(obstacle("x^2+y^2+z^2=1", from, to, top, 3.1).kind, Obstacle::Kind::no_way);
}

TEST(FindObstacle, WhatWasNotTriedComesBeforeWhatIsThere) {
  const Surface sphere = parse_surface("x^2+y^2+z^2=1");
  const Vector from = Eigen::Vector3d(1, 0, 0);
  const Vector to = Eigen::Vector3d(-1, 0, 0);
  EXPECT_EQ(detail::find_obstacle(sphere, from, to, {.walked = false}).kind, Obstacle::Kind::sheets_not_told);
  EXPECT_EQ(detail::find_obstacle(sphere, from, to, {.resolved = false}).kind, Obstacle::Kind::coarse_cells);
}

}  // namespace
}  // namespace taut
