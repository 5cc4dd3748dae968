#include "march/support.hpp"

namespace taut {
namespace {

// The paper's fast marching does not converge on the surface's own cells: docs/march.md has the figures.
TEST(AxisMarch, HasTheDocumentedBiasOnTheSphere) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(0.36, -0.48, 0.8);
  for (const double h : {0.1, 0.05, 0.025}) {
    SurfaceCells cells = test::all_cells(sphere, source, h);
    const DistanceField field = march(sphere, cells, source, {.method = MarchMethod::axis});
    const double mean = test::sphere_errors(cells, field, source).mean;
    EXPECT_GT(mean, 0.1) << h;
    EXPECT_LT(mean, 0.3) << h;
  }
}

TEST(DijkstraMarch, HasTheDocumentedBiasOnTheSphere) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(0.36, -0.48, 0.8);
  for (const double h : {0.1, 0.05, 0.025}) {
    SurfaceCells cells = test::all_cells(sphere, source, h);
    const DistanceField field = march(sphere, cells, source, {.method = MarchMethod::dijkstra});
    EXPECT_LT(test::sphere_errors(cells, field, source).mean, 0.12) << h;
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (!cells.valid(i)) continue;
      EXPECT_GE(field.distance(i), test::sphere_distance(source, cells.point(i)) * (1 - 1e-4));
    }
  }
}

TEST(BiasedMarch, StopsAtTheTarget) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(1, 0, 0);
  const Vector target = Eigen::Vector3d(0.6, 0.64, 0.48);
  SurfaceCells cells = test::all_cells(sphere, source, 0.05);
  for (const MarchMethod method : {MarchMethod::axis, MarchMethod::dijkstra}) {
    const DistanceField all = march(sphere, cells, source, {.method = method});
    const DistanceField some = march(sphere, cells, source, {.method = method, .target = target});
    EXPECT_EQ(some.target_distance, distance_at(sphere, cells, all, target)(0));
    EXPECT_LT(some.num_reached, all.num_reached);
  }
}

}  // namespace
}  // namespace taut
