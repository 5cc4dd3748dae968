#include "taut/cells/find_cells.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "support/interval_surfaces.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

void expect_same_cells(const Surface& endless, const Vector& start, double size, const std::string& name) {
  // The box that subdivide would find, for both: it drops a few cells that overestimating bounds keep.
  const Surface surface = endless.with_box(find_box(endless, Points(endless.dim(), 0)));
  const Vector seed = project_to_surface(surface, start).point;
  const CellGrid all = subdivide(surface, {.size = size});
  const CellGrid grown = grow(surface, seed, {.size = size, .origin = all.origin()});
  EXPECT_EQ(all.num_cells(), grown.num_cells()) << name;
  EXPECT_TRUE(std::equal(all.coordinates().begin(), all.coordinates().end(), grown.coordinates().begin(),
                         grown.coordinates().end()))
      << name;
}

TEST(Grow, GivesTheCellsOfSubdivideOnConnectedSurfaces) {
  for (const Index d : {2, 3, 4, 5}) {
    expect_same_cells(test::bounded_sphere(Vector::Zero(d), 1), Vector::Unit(d, 0), d < 4 ? 0.04 : 0.3, "sphere");
    const Surface ellipsoid = test::generic_surface(d, 1, [](const auto& x, auto& y) {
      y[0] = test::square(x[0]) - 1.0;
      for (std::size_t a = 1; a < x.size(); ++a) y[0] = y[0] + (1 + 3.0 * static_cast<double>(a)) * test::square(x[a]);
    });
    expect_same_cells(ellipsoid, Vector::Unit(d, 0), d < 4 ? 0.03 : 0.2, "ellipsoid");
  }
  expect_same_cells(test::bounded_torus(), Eigen::Vector3d(1.4, 0, 0), 0.03, "torus");
  expect_same_cells(test::bounded_torus(1, 0.1), Eigen::Vector3d(1.1, 0, 0), 0.03, "thin torus");
  expect_same_cells(test::bounded_tangle_cube(), Eigen::Vector3d(2, 1.5, 0.5), 0.05, "tangle cube");
  expect_same_cells(test::bounded_sphere(Eigen::Vector3d(500, 0, 0), 1e-3), Eigen::Vector3d(500.001, 0, 0), 1e-4,
                    "small sphere far away");
}

TEST(Grow, GivesTheCellsOfSubdivideOnRandomSmoothSurfaces) {
  std::mt19937_64 random(99);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Index d = 2; d <= 4; ++d) {
    for (int repeat = 0; repeat < 8; ++repeat) {
      // Star-shaped: |x|^2 - 1 + small waves along random oblique directions.
      Eigen::MatrixXd waves(d, 3);
      for (auto& w : waves.reshaped()) w = 3 * uniform(random);
      const Surface surface = test::generic_surface(d, 1, [waves](const auto& x, auto& y) {
        y[0] = test::square(x[0]) - 1.0;
        for (std::size_t a = 1; a < x.size(); ++a) y[0] = y[0] + test::square(x[a]);
        for (Index w = 0; w < waves.cols(); ++w) {
          auto phase = waves(0, w) * x[0];
          for (std::size_t a = 1; a < x.size(); ++a) phase = phase + waves(static_cast<Index>(a), w) * x[a];
          y[0] = y[0] + 0.12 * test::sine(phase);
        }
      });
      expect_same_cells(surface, Vector::Unit(d, 0), d < 4 ? 0.05 : 0.25,
                        "d " + std::to_string(d) + " repeat " + std::to_string(repeat));
    }
  }
}

TEST(Grow, ACurveInSpaceToo) {
  const Surface circle = test::generic_surface(3, 2, [](const auto& x, auto& y) {
    y[0] = test::square(x[0]) + test::square(x[1]) + test::square(x[2]) - 1.0;
    y[1] = x[2] - 0.5 * x[0];
  });
  expect_same_cells(circle, Eigen::Vector3d(0, 1, 0), 0.02, "circle");
}

TEST(Grow, StaysOnTheSeedsComponent) {
  // Two spheres: F = (|x - a|^2 - 1) (|x + a|^2 - 1).
  const Surface two = test::generic_surface(3, 1, [](const auto& x, auto& y) {
    const auto rest = test::square(x[1]) + test::square(x[2]) - 1.0;
    y[0] = (test::square(x[0] - 2.0) + rest) * (test::square(x[0] + 2.0) + rest);
  });
  const CellGrid all = subdivide(two, {.size = 0.1});
  const Components parts = components(all);
  EXPECT_EQ(parts.count, 2);
  const Index left = all.find_point(Eigen::Vector3d(-1, 0, 0));
  const Index right = all.find_point(Eigen::Vector3d(1, 0, 0));
  EXPECT_NE(parts.label[static_cast<std::size_t>(left)], parts.label[static_cast<std::size_t>(right)]);
  const CellGrid one = grow(two, Eigen::Vector3d(3, 0, 0), {.size = 0.1, .origin = all.origin()});
  EXPECT_EQ(one.find_point(Eigen::Vector3d(-1, 0, 0)), CellGrid::kNone);
  Points seeds(3, 3);
  seeds.col(0) << 3, 0, 0;
  seeds.col(1) << 100, 0, 0;    // off the surface: left out
  seeds.col(2) << -3.12, 0, 0;  // beside it: projected
  EXPECT_EQ(grow(two, seeds, {.size = 0.1, .origin = all.origin()}).num_cells(), all.num_cells());
}

TEST(Grow, WorksWithoutBounds) {
  const CellGrid bounded = grow(test::bounded_sphere(Vector::Zero(3), 1), Eigen::Vector3d(1, 0, 0), 0.05);
  const CellGrid taylor = grow(test::unit_sphere(), Eigen::Vector3d(1, 0, 0), 0.05);
  for (Index i = 0; i < bounded.num_cells(); ++i) EXPECT_NE(taylor.find(bounded.cell(i)), CellGrid::kNone);
  EXPECT_LE(taylor.num_cells(), 1.1 * static_cast<double>(bounded.num_cells()));
}

TEST(Grow, EndsInAClearErrorWhereTheSurfaceDoesNot) {
  const Surface plane = test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = x[0] + 0.5 * x[1]; });
  EXPECT_THROW((void)grow(plane, Eigen::Vector3d(0, 0, 0), 0.01, {.memory_limit = 3'000'000}), OutOfMemory);
  const Surface window = plane.with_box({Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)});
  EXPECT_GT(grow(window, Eigen::Vector3d(0, 0, 0), 0.1).num_cells(), 400);
  EXPECT_THROW((void)grow(plane, Eigen::Vector3d(9, 0, 0), 0.1), EmptySurface);
  EXPECT_THROW((void)grow(plane, Points(3, 0), 0.1), InvalidArgument);
  EXPECT_THROW((void)grow(plane, Eigen::Vector3d(0, 0, 0), 0), InvalidArgument);
}

// Appendix I: each cell looked at is tested once, and each cell of the patch looks at its 2 d neighbours.
TEST(Grow, CountsItsWork) {
  for (const Index d : {2, 3, 4}) {
    const Surface sphere = test::bounded_sphere(Vector::Zero(d), 1);
    CellCounts grown;
    const Index n = grow(sphere, Vector::Unit(d, 0), {.size = 0.2, .counts = &grown}).num_cells();
    EXPECT_EQ(grown.num_lookups, 2 * d * n);
    EXPECT_GT(grown.num_tests, n);
    EXPECT_LE(grown.num_tests, 1 + grown.num_lookups);
    CellCounts halved;
    const Index m = subdivide(sphere, {.size = 0.2, .counts = &halved}).num_cells();
    EXPECT_EQ(halved.num_lookups, 0);
    // The halves of each cell of the level above, of which there are fewer.
    EXPECT_GT(halved.num_tests, m);
    EXPECT_LE(halved.num_tests, 2 * (Index{1} << d) * m);
  }
}

TEST(Grow, StopsAtItsBudgetAndSaysSo) {
  const Surface sphere = test::bounded_sphere(Vector::Zero(3), 1);
  CellCounts counts;
  const Index all = grow(sphere, Vector::Unit(3, 0), {.size = 0.05, .counts = &counts}).num_cells();
  EXPECT_TRUE(counts.complete);
  const Index some = grow(sphere, Vector::Unit(3, 0), {.size = 0.05, .counts = &counts, .most_cells = 500}).num_cells();
  EXPECT_FALSE(counts.complete);
  EXPECT_GE(some, 500);
  EXPECT_LT(some, 700) << "the front at hand is finished, no more";
  (void)grow(sphere, Vector::Unit(3, 0), {.size = 0.05, .counts = &counts, .most_cells = all + 1});
  EXPECT_TRUE(counts.complete);
}

TEST(Components, AcrossFacesCornersDoNotCount) {
  CellGrid grid(Vector::Zero(9), 1);  // more dimensions than have lists of all neighbours
  std::vector<std::int32_t> cell(9, 0);
  grid.insert(cell);
  cell[3] = 1;
  grid.insert(cell);
  cell[4] = -1;
  grid.insert(cell);
  for (auto& c : cell) ++c;  // touches the last one in a corner
  grid.insert(cell);
  const Components parts = components_across_faces(grid);
  EXPECT_EQ(parts.count, 2);
  EXPECT_EQ(parts.label, (std::vector<std::int32_t>{0, 0, 0, 1}));
}

TEST(Components, AlikeForCellsThatTouchInACorner) {
  CellGrid grid(Vector::Zero(3), 1);
  for (std::int32_t c = 0; c < 4; ++c) grid.insert(std::vector<std::int32_t>{c, -c, c});
  grid.insert(std::vector<std::int32_t>{5, -5, 5});
  const Components parts = components(grid);
  EXPECT_EQ(parts.count, 2);
  EXPECT_EQ(parts.label, (std::vector<std::int32_t>{0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace taut
