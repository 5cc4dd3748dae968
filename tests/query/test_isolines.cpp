#include "taut/query/distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/query/surface_mesh.hpp"

namespace taut {
namespace {

double length_of(const Points& line) {
  return (line.rightCols(line.cols() - 1) - line.leftCols(line.cols() - 1)).colwise().norm().sum();
}

/// Two triangles over the unit square: x is linear on them.
TEST(Isolines, AreStraightWhereTheValueIsLinear) {
  TriangleMesh square;
  square.vertices = Points(3, 4);
  square.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  square.faces = Eigen::Matrix3Xi(3, 2);
  square.faces << 0, 0, 1, 2, 2, 3;
  const Vector x = square.vertices.row(0).transpose();
  const Polylines lines = trace_isolines(square, x, {0.25, 0.5, 7});
  ASSERT_EQ(lines.lines.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Points& line = lines.lines[i];
    ASSERT_EQ(line.cols(), 3);
    EXPECT_NEAR(line.row(0).minCoeff(), 0.25 * static_cast<double>(i + 1), 1e-15);
    EXPECT_NEAR(length_of(line), 1, 1e-15);
  }
  EXPECT_EQ(lines.scalars.front().values(3), 0.5);
}

/// On the unit sphere they are circles, closed, every point at its distance to rounding.
TEST(Isolines, OfDistancesAreExactAndClosed) {
  const Surface sphere = test::unit_sphere();
  const Eigen::Vector3d p(0.6, 0, 0.8);
  DistanceSolver solver(sphere, Vector(p));
  const SurfaceMesh mesh = display_mesh(sphere, {.cell = 0.2});
  const Distances u = solver.at(mesh.vertices);
  const std::vector<double> levels = {0.5, 1.5, 2.7};
  Index moved = 0;
  const Polylines lines = distance_isolines(solver, mesh, u.distance, levels, &moved);
  ASSERT_EQ(lines.lines.size(), levels.size());
  EXPECT_EQ(moved, lines.num_points());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Points& line = lines.lines[i];
    EXPECT_EQ(line.col(0), line.col(line.cols() - 1));
    for (Index j = 0; j < line.cols(); ++j) {
      EXPECT_NEAR(std::acos(p.dot(line.col(j).head<3>())), levels[i], 1e-10);
      EXPECT_NEAR(line.col(j).norm(), 1, 1e-12);
    }
    const double circle = 2 * std::numbers::pi * std::sin(levels[i]);
    EXPECT_NEAR(length_of(line), circle, 0.05 * circle);
  }
}

TEST(Isolines, EvenLevelsLeaveOutBothEnds) {
  const std::vector<double> levels = even_levels(Eigen::Vector3d(0, 4, std::nan("")), 3);
  EXPECT_EQ(levels, (std::vector<double>{1, 2, 3}));
  EXPECT_THROW((void)trace_isolines(TriangleMesh{}, Vector::Zero(1), {1}), InvalidArgument);
}

}  // namespace
}  // namespace taut
