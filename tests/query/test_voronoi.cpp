#include "taut/query/point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

/// On a sphere the parts are those of the straight distances: their borders are great circles.
TEST(Voronoi, OfTheSphereHasGreatCircles) {
  const Points sources = (Points(3, 6) << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1).finished();
  const VoronoiResult cube = geodesic_voronoi(test::unit_sphere(), sources);
  EXPECT_EQ(cube.num_exact, cube.mesh.vertices.cols());
  for (Index v = 0; v < cube.mesh.vertices.cols(); ++v) {
    Index nearest = 0;
    const Vector similar = sources.transpose() * cube.mesh.vertices.col(v);
    const double most = similar.maxCoeff(&nearest);
    const auto label = cube.label[static_cast<std::size_t>(v)];
    EXPECT_NEAR(similar(label), most, 1e-9);
    EXPECT_EQ(cube.mesh.scalars[1].values(v), label);
  }
  EXPECT_EQ(cube.boundaries.lines.size(), 12U) << "the edges of a cube";
  Index point = 0;
  for (const Points& line : cube.boundaries.lines) {
    const auto left = static_cast<Index>(cube.boundaries.scalars[0].values(point));
    const auto right = static_cast<Index>(cube.boundaries.scalars[1].values(point));
    EXPECT_LT(left, right);
    for (Index i = 1; i + 1 < line.cols(); ++i) {  // the ends are where three parts meet
      EXPECT_NEAR(sources.col(left).dot(line.col(i)), sources.col(right).dot(line.col(i)), 1e-9);
    }
    // The lower number is to the left seen from outside.
    const Eigen::Vector3d along = line.col(1) - line.col(0);
    const Eigen::Vector3d outside = line.col(0);
    EXPECT_GT(outside.cross(along).dot(sources.col(left) - sources.col(right)), 0);
    point += line.cols();
  }
}

TEST(Voronoi, OfTwoPointsIsOneClosedLine) {
  const Surface surface = parse_surface("x^2+y^2+4z^2=1");
  const Points sources = (Points(3, 2) << 1, -1, 0, 0, 0, 0).finished();
  const VoronoiResult halves = geodesic_voronoi(surface, sources);
  ASSERT_EQ(halves.boundaries.lines.size(), 1U);
  const Points& line = halves.boundaries.lines.front();
  EXPECT_EQ(line.col(0), line.col(line.cols() - 1));
  EXPECT_LT(line.row(0).cwiseAbs().maxCoeff(), 1e-8) << "x = 0 by symmetry";
  EXPECT_EQ(halves.num_exact_boundary, halves.boundaries.num_points() - 1);
}

TEST(Voronoi, LeavesOutWhatNoSourceReaches) {
  const Surface two = parse_surface("((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)");
  const VoronoiResult found = geodesic_voronoi(two, Vector(Eigen::Vector3d(3, 0, 0)));
  for (Index v = 0; v < found.mesh.vertices.cols(); ++v) {
    EXPECT_EQ(found.label[static_cast<std::size_t>(v)], found.mesh.vertices(0, v) > 0 ? 0 : -1);
  }
  EXPECT_TRUE(found.boundaries.lines.empty());
  EXPECT_THROW((void)geodesic_voronoi(test::unit_sphere(4), Vector::Unit(4, 0)), InvalidArgument);
}

}  // namespace
}  // namespace taut
