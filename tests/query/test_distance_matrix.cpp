#include "taut/query/distance_matrix.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

Points random_points(const Surface& surface, Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Points points(surface.dim(), n);
  for (Index j = 0; j < n;) {
    Vector x(surface.dim());
    for (double& c : x) c = normal(random);
    const ProjectionResult projected = project_to_surface(surface, x.normalized());
    if (projected.converged) points.col(j++) = projected.point;
  }
  return points;
}

TEST(DistanceMatrix, OfTheSphereIsExactAndSymmetric) {
  for (const Index d : {3, 4}) {
    const Surface sphere = test::unit_sphere(d);
    const Points points = random_points(sphere, d == 3 ? 40 : 12, 1);
    const Eigen::MatrixXd u = distance_matrix(sphere, points);
    for (Index i = 0; i < points.cols(); ++i) {
      EXPECT_EQ(u(i, i), 0);
      for (Index j = 0; j < points.cols(); ++j) {
        EXPECT_EQ(u(i, j), u(j, i));
        const double chord = (points.col(i) - points.col(j)).norm();
        EXPECT_NEAR(u(i, j), 2 * std::asin(std::min(1.0, chord / 2)), 1e-9);
      }
    }
  }
}

TEST(DistanceMatrix, KeepsTheTriangleInequality) {
  const Surface torus = test::torus(1, 0.4);
  const Eigen::MatrixXd u = distance_matrix(torus, random_points(torus, 25, 2));
  EXPECT_TRUE(u.allFinite());
  for (Index i = 0; i < u.cols(); ++i) {
    for (Index j = 0; j < u.cols(); ++j) {
      for (Index k = 0; k < u.cols(); ++k) EXPECT_LE(u(i, k), u(i, j) + u(j, k) + 1e-9);
    }
  }
}

/// However rows are asked for, and by how many threads, the bits are the same.
TEST(DistanceMatrix, RowsDoNotDependOnTheirBlock) {
  const Surface surface = parse_surface("x^2+2y^2+4z^2=1");
  const Points points = random_points(surface, 12, 3);
  DistanceMatrix one(surface, points, {}, {.threads = 1});
  DistanceMatrix two(surface, points, {}, {.threads = 2});
  const std::vector<MatrixRow> all = one.rows(0, 12);
  for (const Index i : {7, 0, 11}) {
    const MatrixRow row = two.rows(i, 1).front();
    EXPECT_EQ(row.column, all[static_cast<std::size_t>(i)].column);
    EXPECT_EQ(row.distance, all[static_cast<std::size_t>(i)].distance);
  }
}

TEST(DistanceMatrix, HasTheNearestAndTheNear) {
  const Surface sphere = test::unit_sphere();
  const Points points = random_points(sphere, 60, 4);
  const Eigen::MatrixXd u = distance_matrix(sphere, points);
  DistanceMatrix nearest(sphere, points, {.k_nearest = 4});
  for (const MatrixRow& row : nearest.rows(0, 60)) {
    std::vector<double> others;
    for (Index j = 0; j < 60; ++j) {
      if (j != row.row) others.push_back(u(row.row, j));
    }
    std::ranges::sort(others);
    ASSERT_EQ(row.column.size(), 4U);
    for (std::size_t s = 0; s < 4; ++s) EXPECT_NEAR(row.distance[s], others[s], 1e-10);
  }
  DistanceMatrix near(sphere, points, {.distance = {.max_distance = 0.5}});
  std::size_t count = 0;
  for (const MatrixRow& row : near.rows(0, 60)) {
    for (std::size_t s = 0; s < row.column.size(); ++s, ++count) {
      EXPECT_GT(row.column[s], row.row);
      EXPECT_NEAR(row.distance[s], u(row.row, row.column[s]), 1e-10);
    }
  }
  EXPECT_EQ(count, static_cast<std::size_t>((u.array() <= 0.5).count() - 60) / 2);
}

TEST(DistanceMatrix, GoesFromPointsToTargets) {
  const Surface two = parse_surface("((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)");
  const Points points = (Points(3, 2) << 3, -3, 0, 0, 0, 0).finished();
  const Points targets = (Points(3, 3) << 1, -1, 2, 0, 0, 1, 0, 0, 0).finished();
  DistanceMatrix solver(two, points, targets);
  EXPECT_FALSE(solver.symmetric());
  const std::vector<MatrixRow> rows = solver.rows(0, 2);
  using std::numbers::pi;
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(rows[0].distance[0], pi, 1e-9);
  EXPECT_EQ(rows[0].distance[1], inf);
  EXPECT_NEAR(rows[0].distance[2], pi / 2, 1e-9);
  EXPECT_EQ(rows[1].distance[0], inf);
  EXPECT_NEAR(rows[1].distance[1], pi, 1e-9);
}

TEST(DistanceMatrix, RefusesWrongRequests) {
  const Surface sphere = test::unit_sphere();
  const Points points = random_points(sphere, 3, 5);
  EXPECT_THROW(DistanceMatrix(sphere, Points(3, 0)), InvalidArgument);
  EXPECT_THROW(DistanceMatrix(sphere, Points::Constant(3, 1, 9)), InvalidArgument);
  EXPECT_THROW(DistanceMatrix(sphere, points, Points(Points::Zero(2, 1))), InvalidArgument);
  EXPECT_THROW(DistanceMatrix(sphere, points, {.k_nearest = -1}), InvalidArgument);
  DistanceMatrix solver(sphere, points);
  EXPECT_THROW((void)solver.rows(2, 2), InvalidArgument);
  EXPECT_THROW((void)distance_matrix(sphere, points, {.k_nearest = 1}), InvalidArgument);
}

}  // namespace
}  // namespace taut
