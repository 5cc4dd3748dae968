#include "taut/cells/surface_cells.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "support/interval_surfaces.hpp"
#include "support/surfaces.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

/// Expands everything that can be reached.
void expand_all(SurfaceCells& cells) {
  for (Index i = 0; i < cells.num_cells(); ++i) cells.expand(i);
}

std::set<std::vector<std::int32_t>> cell_set(const CellGrid& grid) {
  std::set<std::vector<std::int32_t>> result;
  for (Index i = 0; i < grid.num_cells(); ++i) result.emplace(grid.cell(i).begin(), grid.cell(i).end());
  return result;
}

TEST(SurfaceCells, LazyGrowthCoversTheSphere) {
  for (const Index d : {2, 3, 4, 5}) {
    const Surface sphere = test::unit_sphere(d);
    const double size = d <= 3 ? 0.1 : 0.35;
    SurfaceCells cells = SurfaceCells::lazy(sphere, Vector::Unit(d, 0), size);
    EXPECT_LT(cells.num_cells(), 200);
    expand_all(cells);
    // Every surface point lies in a cell, with a representative near by.
    const Points random = Points::Random(d, 500);
    for (Index j = 0; j < random.cols(); ++j) {
      const Vector x = random.col(j).normalized();
      const Index i = cells.grid().find_point(x);
      ASSERT_NE(i, CellGrid::kNone);
      EXPECT_TRUE(cells.valid(i));
    }
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (!cells.valid(i)) continue;
      EXPECT_NEAR(cells.point(i).norm(), 1, 1e-12);
      EXPECT_LE((cells.point(i) - cells.grid().centre(i)).lpNorm<Eigen::Infinity>(), 1.5 * size);
      EXPECT_LE((cells.normals(i) - cells.point(i)).norm(), 1e-12);
    }
  }
}

TEST(SurfaceCells, CompleteAndLazyAgree) {
  const Surface torus = test::torus();
  SurfaceCells lazy = SurfaceCells::lazy(torus, Eigen::Vector3d(1.4, 0, 0), 0.1);
  expand_all(lazy);
  const SurfaceCells complete(torus, lazy.grid().sorted());
  EXPECT_EQ(cell_set(lazy.grid()), cell_set(complete.grid()));
  EXPECT_EQ(lazy.num_valid(), complete.num_valid());
  for (Index i = 0; i < lazy.num_cells(); ++i) {
    const Index j = complete.grid().find(lazy.grid().cell(i));
    ASSERT_NE(j, CellGrid::kNone);
    EXPECT_EQ(lazy.valid(i), complete.valid(j));
    EXPECT_EQ(Vector(lazy.point(i)), Vector(complete.point(j)));
    EXPECT_EQ(Eigen::MatrixXd(lazy.normals(i)), Eigen::MatrixXd(complete.normals(j)));
  }
}

TEST(SurfaceCells, ThreadsDoNotChangeThem) {
  const Surface torus = test::torus();
  SurfaceCells lazy = SurfaceCells::lazy(torus, Eigen::Vector3d(1.4, 0, 0), 0.04);
  expand_all(lazy);
  const SurfaceCells one(torus, lazy.grid(), {.threads = 1});
  const SurfaceCells four(torus, lazy.grid(), {.threads = 4});
  for (Index i = 0; i < one.num_cells(); ++i) {
    ASSERT_EQ(one.valid(i), four.valid(i));
    ASSERT_EQ(Vector(one.point(i)), Vector(four.point(i)));
  }
}

TEST(SurfaceCells, EveryCellAtTheEdgeOfTheDomainIsRepresentedInside) {
  SurfaceExtras extras;
  extras.domain = test::generic_function(3, 2, [](const auto& x, auto& y) {
    y[0] = x[2] - 0.1 * x[0] - 0.3;
    y[1] = 0.7 - x[0];
  });
  const Surface cap = test::bounded_sphere(Vector::Zero(3), 1, true, extras);
  const SurfaceCells cells(cap, subdivide(cap, {.size = 0.1}));
  EXPECT_GE(cells.num_valid(),
            cells.num_cells() - 2);  // a corner of a cell may touch the surface outside the domain only
  for (Index i = 0; i < cells.num_cells(); ++i) {
    if (!cells.valid(i)) continue;
    EXPECT_NEAR(cells.point(i).norm(), 1, 1e-12);
    EXPECT_TRUE(cap.inside_domain(cells.point(i), 1e-9)(0));
    EXPECT_LE((cells.normals(i) - cells.point(i)).norm(), 1e-12);
  }
}

TEST(SurfaceCells, SheetsThinnerThanACellKeepTheirCells) {
  // Two parallel planes 0.02 apart: cell centres half-way have no gradient.
  const Surface sheets = test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[2]) - 1e-4; });
  const Box box{Vector::Constant(3, -1), Vector::Constant(3, 1)};
  const SurfaceCells cells(
      sheets, subdivide(sheets, {.size = 0.1, .box = box, .origin = Vector(Eigen::Vector3d(0.03, 0.03, -0.05))}));
  EXPECT_EQ(cells.num_valid(), cells.num_cells());
}

TEST(SurfaceCells, RefusesSeedsOffTheSurface) {
  EXPECT_THROW((void)SurfaceCells::lazy(test::unit_sphere(), Eigen::Vector3d(0, 0, 0), 0.1), EmptySurface);
  EXPECT_THROW((void)SurfaceCells::lazy(test::unit_sphere(), Points(3, 0), 0.1), InvalidArgument);
  EXPECT_THROW((void)SurfaceCells::lazy(test::unit_sphere(), Eigen::Vector2d(1, 0), 0.1), InvalidArgument);
  CellGrid inside(Vector::Zero(3), 0.1);
  inside.insert(std::vector<std::int32_t>{0, 0, 0});
  EXPECT_THROW(SurfaceCells(test::unit_sphere(), inside), EmptySurface);
}

TEST(SurfaceCells, StopsBeforeTheMemoryIsGone) {
  SurfaceCells cells =
      SurfaceCells::lazy(test::unit_sphere(), Eigen::Vector3d(1, 0, 0), 0.01, {.memory_limit = 200'000});
  EXPECT_THROW(expand_all(cells), OutOfMemory);
}

TEST(SurfaceCells, CellAtLooksWhereNobodyHasBeen) {
  SurfaceCells cells = SurfaceCells::lazy(test::unit_sphere(), Eigen::Vector3d(1, 0, 0), 0.05);
  EXPECT_EQ(cells.grid().find_point(Eigen::Vector3d(-1, 0, 0)), CellGrid::kNone);
  const Index i = cells.cell_at(Eigen::Vector3d(-1, 0, 0));
  ASSERT_NE(i, CellGrid::kNone);
  EXPECT_TRUE(cells.valid(i));
  EXPECT_EQ(cells.cell_at(Eigen::Vector3d(0, 0, 0)), CellGrid::kNone);
}

}  // namespace
}  // namespace taut
