// What is asked of many points at once, on surfaces with edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "taut/query/distance.hpp"
#include "taut/query/distance_matrix.hpp"
#include "taut/query/field.hpp"
#include "taut/query/path.hpp"
#include "taut/query/point_sets.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

Surface cube() { return parse_surface("max(abs(x),abs(y),abs(z))=1"); }

/// From the middle of the top: on the top itself, and on a side by the nearest of three unfoldings.
double from_top(const Eigen::Vector3d& x) {
  if (x.z() >= 1 - 1e-9) return x.head<2>().norm();
  double least = 1e300;
  for (const int axis : {0, 1}) {
    const double out = std::abs(x(axis));
    if (x.z() > -1 + 1e-9 && out >= 1 - 1e-9) {
      const double across = x(1 - axis);
      least = std::min(least, std::hypot(2 - x.z(), across));                            // over this side's edge
      least = std::min(least, std::hypot(1 + (1 - std::abs(across)), 1 + (1 - x.z())));  // over the next side
    }
    if (x.z() <= -1 + 1e-9) {
      for (const double sign : {1.0, -1.0})
        least = std::min(least, std::hypot(1 + 2 + 1 - sign * x(axis), x(1 - axis)));
    }
  }
  return least;
}

TEST(EdgeFields, MarchUnfoldsTheFaces) {
  const Eigen::Vector3d source(0, 0, 1);
  const FieldResult field = marched_field(cube(), source, {.cell = 0.1});
  EXPECT_TRUE(field.over_mesh);
  ASSERT_EQ(field.distance.size(), field.mesh.vertices.cols());
  double worst = 0;
  for (Index v = 0; v < field.mesh.vertices.cols(); ++v) {
    const Eigen::Vector3d x = field.mesh.vertices.col(v);
    if (x.z() <= -1 + 1e-9) continue;  // ways over two sides are not in from_top
    worst = std::max(worst, std::abs(field.distance(v) - from_top(x)));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(EdgeFields, DistancesAreThoseOfPaths) {
  const Eigen::Vector3d source(0, 0, 1);
  Points targets(3, 3);
  targets.col(0) << 1, 0, 0;
  targets.col(1) << 1, 0.5, 0.5;
  targets.col(2) << 0, 0, -1;
  DistanceSolver solver(cube(), source);
  EXPECT_FALSE(solver.has_fan());
  const Distances found = solver.at(targets);
  EXPECT_NEAR(found.distance(0), 2, 1e-12);
  EXPECT_NEAR(found.distance(1), std::hypot(1.5, 0.5), 1e-12);
  EXPECT_NEAR(found.distance(2), 4, 1e-12);
  for (int j = 0; j < 3; ++j) EXPECT_EQ(found.proof[static_cast<std::size_t>(j)], DistanceProof::path);
}

TEST(EdgeFields, PointsAreSpreadOverAllFaces) {
  const FarthestPoints chosen = farthest_points(cube(), Eigen::Vector3d(0, 0, 1), 6, {.cell = 0.1});
  ASSERT_EQ(chosen.points.cols(), 6);
  EXPECT_NEAR(chosen.points(2, 1), -1, 1e-6);  // the farthest one lies on the bottom
  EXPECT_LT(chosen.cover.back(), 2.1);
}

TEST(EdgeFields, PartsReachOverEdges) {
  Points sources(3, 2);
  sources.col(0) << 0, 0, 1;
  sources.col(1) << 0, 0, -1;
  const VoronoiResult parts = geodesic_voronoi(cube(), sources, {.cell = 0.1});
  for (Index v = 0; v < parts.mesh.vertices.cols(); ++v) {
    const double z = parts.mesh.vertices(2, v);
    if (std::abs(z) <= 0.1) continue;
    EXPECT_EQ(parts.label[static_cast<std::size_t>(v)], z > 0 ? 0 : 1) << z;
  }
}

TEST(EdgeFields, PolylinesCrossEdges) {
  Points polyline(3, 5);
  polyline << 2, 2, 0, -2, -2,  //
      0, 0, 0.5, 0, 0,          //
      0.9, 1, 1, 1, 0.9;
  const PathResult found = path_in_class(parse_surface("max(x^2+y^2-4, abs(z)-1)"), polyline);
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_NEAR(found.length, 4.2, 1e-11);
}

TEST(EdgeFields, MeansAreRefused) {
  Points points(3, 2);
  points.col(0) << 0, 0, 1;
  points.col(1) << 1, 0, 0;
  EXPECT_THROW((void)karcher_mean(cube(), points), InvalidArgument);
}

}  // namespace
}  // namespace taut
