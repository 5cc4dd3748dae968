#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "march/support.hpp"
#include "support/interval_surfaces.hpp"
#include "taut/cells/find_cells.hpp"

namespace taut {
namespace {

// The paper's fast marching does not converge on the surface's own cells: docs/measured/march.md has the figures.
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
    const double mean = test::sphere_errors(cells, field, source).mean;  // 1.6 to 1.9 %
    EXPECT_GT(mean, 0.01) << h;
    EXPECT_LT(mean, 0.025) << h;
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (!cells.valid(i)) continue;
      EXPECT_GE(field.distance(i), test::sphere_distance(source, cells.point(i)) * (1 - 1e-4));
    }
  }
}

/// A plane in a box, askew to nothing: its cells are a square lattice.
Surface plane() {
  const Surface endless = test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = x[2] - 0.3; });
  return endless.with_box({Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)});
}

/// Length of the shortest walk over steps to cells that touch: of as many axes at a time as are left to go.
double chamfer(std::array<double, 3> steps) {
  for (double& step : steps) step = std::abs(step);
  std::ranges::sort(steps, std::greater<>());
  return steps[0] - steps[1] + std::numbers::sqrt2 * (steps[1] - steps[2]) + std::numbers::sqrt3 * steps[2];
}

std::array<double, 3> steps_between(const CellGrid& grid, Index i, Index j) {
  std::array<double, 3> steps{};
  for (std::size_t a = 0; a < 3; ++a) steps.at(a) = grid.cell(i)[a] - grid.cell(j)[a];
  return steps;
}

TEST(DijkstraMarch, IsExactOnALattice) {
  const Surface surface = plane();
  const SurfaceCells bare(surface, subdivide(surface, {.size = 0.1}));
  for (const Index layers : {0, 3}) {
    SurfaceCells cells = bare.thickened(layers);
    const Index source = cells.grid().find_point(Eigen::Vector3d(0.13, -0.22, 0.3));
    const Vector start = layers == 0 ? Vector(cells.point(source)) : cells.grid().centre(source);
    const DistanceField field = march(surface, cells, start, {.method = MarchMethod::dijkstra});
    ASSERT_GT(field.num_reached, 400 * (1 + layers));
    for (Index i = 0; i < bare.num_cells(); ++i) {
      EXPECT_NEAR(field.distance(i), 0.1 * chamfer(steps_between(cells.grid(), i, source)), 1e-12) << layers;
    }
    // The path back is as long: over the cells that were walked.
    const Points line = descend(surface, cells, field, bare.point(0));
    const double more = layers == 0 ? 0 : 2 * 0.1;  // from the centres to the ends
    EXPECT_NEAR(test::polyline_length(line), field.distance(0), more + 1e-12);
  }
}

// Sethian's upwind differences around one cell: u along an axis, and h (1 + 1 / sqrt 2) on the diagonal.
TEST(AxisMarch, SolvesTheUpwindDifferencesOfAPlane) {
  const Surface surface = plane();
  SurfaceCells cells(surface, subdivide(surface, {.size = 0.1}));
  const CellGrid& grid = cells.grid();
  const Index source = grid.find_point(Eigen::Vector3d(0.13, -0.22, 0.3));
  const DistanceField field = march(surface, cells, grid.centre(source), {.method = MarchMethod::axis});
  EXPECT_TRUE(field.at_centres);
  EXPECT_EQ(field.num_reached, cells.num_cells());
  const auto at = [&](std::int32_t x, std::int32_t y) {
    std::vector<std::int32_t> cell(grid.cell(source).begin(), grid.cell(source).end());
    cell[0] += x;
    cell[1] += y;
    return field.distance(grid.find(cell));
  };
  EXPECT_NEAR(at(3, 0), 0.3, 1e-15);
  EXPECT_NEAR(at(0, -4), 0.4, 1e-15);
  EXPECT_NEAR(at(1, 1), 0.1 * (1 + 1 / std::numbers::sqrt2), 1e-15);
  // (u - u(1, 1))^2 + (u - 2 h)^2 = h^2
  const double a = at(1, 1);
  const double u = (a + 0.2 + std::sqrt(2 * 0.01 - (a - 0.2) * (a - 0.2))) / 2;
  EXPECT_NEAR(at(2, 1), u, 1e-15);
}

// It walks all cells that hang together across faces, also those that the surface only touches, and no others: the path
// on the grid leads over them from touching cell to touching cell.
TEST(AxisMarch, ReachesWhatHangsTogetherAndKeepsToIt) {
  const Surface torus = test::bounded_torus(1, 0.1);
  SurfaceCells cells(torus, subdivide(torus, {.size = 0.15}));
  ASSERT_LT(cells.num_valid(), cells.num_cells());
  const CellGrid& grid = cells.grid();
  const Vector source = Eigen::Vector3d(1.1, 0, 0);
  const DistanceField field = march(torus, cells, source, {.method = MarchMethod::axis});
  EXPECT_EQ(field.num_reached, cells.num_cells());
  for (const Vector& target : {Vector(Eigen::Vector3d(-1.1, 0, 0)), Vector(Eigen::Vector3d(0, -0.9, 0))}) {
    const Points line = descend(torus, cells, field, target);
    ASSERT_GE(line.cols(), 3);
    EXPECT_EQ(line.col(0), source);
    EXPECT_EQ(line.col(line.cols() - 1), target);
    double before = 0;
    for (Index j = 1; j + 1 < line.cols(); ++j) {
      const Index i = grid.find_point(line.col(j));
      ASSERT_NE(i, CellGrid::kNone);
      EXPECT_EQ(line.col(j), grid.centre(i));
      EXPECT_GT(field.distance(i), before);
      before = field.distance(i);
      if (j > 1) {
        EXPECT_LE((line.col(j) - line.col(j - 1)).lpNorm<Eigen::Infinity>(), 0.15 + 1e-12);
      }
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
