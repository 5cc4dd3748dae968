#include "taut/query/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

TEST(Via, LegsOnASphereAreArcsAndAddUp) {
  PathSolver solver(test::unit_sphere(3));
  Points points(3, 4);
  points.col(0) << 1, 0, 0;
  points.col(1) << 0, 1, 0;
  points.col(2) << 0, 0.6, 0.8;
  points.col(3) << 0, 0, -1;
  const ViaResult path = path_through(solver, points);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  ASSERT_EQ(path.legs.size(), 3U);
  const double first = pi / 2;
  const double second = std::acos(0.6);
  const double third = pi - std::acos(0.8);
  EXPECT_NEAR(path.legs[0].length, first, 1e-12);
  EXPECT_NEAR(path.legs[1].length, second, 1e-12);
  EXPECT_NEAR(path.legs[2].length, third, 1e-12);
  EXPECT_NEAR(path.length, first + second + third, 1e-12);
  EXPECT_EQ(path.length_error, path.legs[0].length_error + path.legs[1].length_error + path.legs[2].length_error);
  EXPECT_TRUE(path.unique);
  EXPECT_EQ(path.points.cols(),
            path.legs[0].points.cols() + path.legs[1].points.cols() + path.legs[2].points.cols() - 2);
  for (Index j = 1; j < path.points.cols(); ++j) EXPECT_NE(path.points.col(j), path.points.col(j - 1));
  EXPECT_EQ(path.points.col(path.legs[0].points.cols() - 1), path.legs[1].from);
}

TEST(Via, EachLegIsTheGloballyShortest) {
  // Round the hole of a torus by way of its far side: either half may not take the long way.
  PathSolver solver(test::torus(1, 0.4));
  Points points(3, 3);
  points.col(0) << 0.6, 0, 0;
  points.col(1) << 0.6 * std::cos(3), 0.6 * std::sin(3), 0;
  points.col(2) << 0.6, 0, 0;
  const ViaResult path = path_through(solver, points);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, 2 * 0.6 * 3, 1e-9);
  EXPECT_EQ(path.from, path.to);
}

TEST(Via, WhatWasMarchedIsToldOfAllLegs) {
  PathSolver solver(test::unit_sphere(3), {.method = CorrectionMethod::grid, .cell = 0.2, .keep_cells = true});
  Points points(3, 3);
  points << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const ViaResult path = path_through(solver, points);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_FALSE(path.corrected);
  EXPECT_EQ(path.marched, path.legs[0].marched + path.legs[1].marched);
  EXPECT_EQ(path.grid, GridMethod::subdivide);
  EXPECT_EQ(path.grid_path.cols(), path.legs[0].grid_path.cols() + path.legs[1].grid_path.cols() - 1);
  EXPECT_GT(path.walked_cells.cols(), 20);
  EXPECT_EQ(path.walked_cells.cols(), path.legs[0].walked_cells.cols() + path.legs[1].walked_cells.cols());
}

TEST(Via, OneLegIsThePathItself) {
  const Surface surface = test::ellipsoid(1, 0.8, 0.5);
  PathSolver solver(surface);
  Points points(3, 2);
  points.col(0) << 1, 0, 0;
  points.col(1) << 0, 0.3, 0.4;
  const ViaResult path = path_through(solver, points);
  EXPECT_EQ(path.length, shortest_path(surface, points.col(0), points.col(1)).length);
}

TEST(Via, RepeatedPointsAreLegsOfLengthZero) {
  PathSolver solver(test::unit_sphere(3));
  Points points = Eigen::Vector3d(1, 0, 0).replicate(1, 3);
  const ViaResult still = path_through(solver, points);
  EXPECT_EQ(still.status, Status::ok);
  EXPECT_EQ(still.length, 0);
  EXPECT_EQ(still.points.cols(), 2);
  points.col(2) << 0, 1, 0;
  EXPECT_NEAR(path_through(solver, points).length, pi / 2, 1e-12);
}

TEST(Via, NamesTheLegThatFails) {
  PathSolver solver(parse_surface("(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0"));
  Points points(3, 4);
  points.col(0) << 1, 0, 0;
  points.col(1) << 0, 1, 0;
  points.col(2) << 5, 0, 0;
  points.col(3) << 4, 1, 0;
  const ViaResult path = path_through(solver, points);
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.message.starts_with("leg 2 of 3: ")) << path.message;
  EXPECT_EQ(path.points.cols(), 0);
  EXPECT_NEAR(path.legs[0].length, pi / 2, 1e-9);
  EXPECT_NEAR(path.legs[2].length, pi / 2, 1e-9);
}

TEST(Via, WrongPointsAreRefusedWithTheirLeg) {
  PathSolver solver(test::unit_sphere(3));
  EXPECT_THROW((void)path_through(solver, Points::Zero(3, 1)), InvalidArgument);
  EXPECT_THROW((void)path_through(solver, Points::Zero(2, 3)), InvalidArgument);
  Points points(3, 3);
  points.col(0) << 1, 0, 0;
  points.col(1) << 0, 1, 0;
  points.col(2) << 90, 0, 0;
  try {
    (void)path_through(solver, points);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("leg 2 of 2: ")) << error.what();
  }
}

}  // namespace
}  // namespace taut
