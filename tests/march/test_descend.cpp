#include <Eigen/Geometry>

#include "march/support.hpp"

namespace taut {
namespace {

void expect_good_line(const Points& line, const Vector& source, const Vector& target, double distance, double h,
                      double slack) {
  ASSERT_GE(line.cols(), 2);
  EXPECT_EQ(line.col(0), source);
  EXPECT_EQ(line.col(line.cols() - 1), target);
  EXPECT_LT(test::polyline_length(line), distance * (1 + slack) + slack * h);
  for (Index j = 1; j + 1 < line.cols(); ++j) {
    EXPECT_GT((line.col(j + 1) - line.col(j)).dot(line.col(j) - line.col(j - 1)), 0) << "reversal at " << j;
  }
}

TEST(Descend, FollowsGreatCircles) {
  const Surface sphere = test::unit_sphere();
  std::mt19937 random(7);
  for (const double h : {0.4, 0.1, 0.03}) {
    const Vector source = test::random_unit(3, random);
    SurfaceCells cells = test::all_cells(sphere, source, h);
    const DistanceField field = march(sphere, cells, source);
    for (int i = 0; i < 20; ++i) {
      const Vector target = test::random_unit(3, random);
      const double distance = test::sphere_distance(source, target);
      const Points line = descend(sphere, cells, field, target);
      expect_good_line(line, source, target, distance, h, 0.02);
      const Vector axis = Eigen::Vector3d(source).cross(Eigen::Vector3d(target)).normalized();
      for (Index j = 0; j < line.cols(); ++j) {
        EXPECT_LT(std::abs(line.col(j).dot(axis)), 0.5 * h) << "beside the great circle";
        EXPECT_LT(std::abs(line.col(j).norm() - 1), 1e-3 * h);
      }
    }
  }
}

TEST(Descend, TorusLinesAreAsLongAsTheDistance) {
  const Surface torus = test::torus(1, 0.4);
  for (const double h : {0.2, 0.05}) {
    const std::vector<test::DistanceRow> rows = test::read_distances("torus_distances.csv", 3);
    SurfaceCells cells = test::all_cells(torus, rows.front().p, h);
    for (const test::DistanceRow& row : rows) {
      const DistanceField field = march(torus, cells, row.p, {.target = row.q});
      const Points line = descend(torus, cells, field, row.q);
      ASSERT_GE(line.cols(), 2);
      EXPECT_EQ(line.col(0), row.p);
      EXPECT_EQ(line.col(line.cols() - 1), row.q);
      EXPECT_LT(test::polyline_length(line), row.distance * 1.05);
    }
  }
}

TEST(Descend, SourceItselfGivesTwoEqualPoints) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(0, 0.6, 0.8);
  SurfaceCells cells = test::all_cells(sphere, source, 0.2);
  for (const MarchMethod method : {MarchMethod::convergent, MarchMethod::axis, MarchMethod::dijkstra}) {
    const DistanceField field = march(sphere, cells, source, {.method = method});
    const Points line = descend(sphere, cells, field, source);
    ASSERT_EQ(line.cols(), 2);
    EXPECT_EQ(line.col(0), source);
    EXPECT_EQ(line.col(1), source);
  }
}

TEST(Descend, BiasedFieldsLeadToTheSourceToo) {
  const Surface torus = test::torus(1, 0.4);
  const std::vector<test::DistanceRow> rows = test::read_distances("torus_distances.csv", 3);
  SurfaceCells cells = test::all_cells(torus, rows.front().p, 0.1);
  for (const MarchMethod method : {MarchMethod::axis, MarchMethod::dijkstra}) {
    for (const test::DistanceRow& row : rows) {
      const DistanceField field = march(torus, cells, row.p, {.method = method, .target = row.q});
      const Points line = descend(torus, cells, field, row.q);
      ASSERT_GE(line.cols(), 2);
      EXPECT_EQ(line.col(0), row.p);
      EXPECT_EQ(line.col(line.cols() - 1), row.q);
      EXPECT_LT(test::polyline_length(line), row.distance * 1.5 + 0.2);
    }
  }
}

}  // namespace
}  // namespace taut
