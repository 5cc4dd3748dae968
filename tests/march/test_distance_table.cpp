#include "march/distance_table.hpp"

#include <algorithm>
#include <numbers>

#include "support.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using namespace detail;

using std::numbers::pi;

SurfaceCells cells_in_box(const Surface& surface, double size, double reach) {
  const Vector corner = Vector::Constant(surface.dim(), reach);
  return {surface, subdivide(surface, {.size = size, .box = Box{-corner, corner}, .origin = {}})};
}

TEST(DistanceTable, StartsAreAsLongAsTheDistanceOnTheSphere) {
  const Surface sphere = test::unit_sphere();
  const DistanceTable table(sphere, cells_in_box(sphere, 0.18, 1.3), 200);
  EXPECT_LE(table.num_landmarks(), 200);
  EXPECT_GE(table.num_landmarks(), 80);
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  int answered = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector p = test::random_unit(3, random);
    const Vector q = test::random_unit(3, random);
    const std::vector<StartPath> paths = table.start_paths(p, q);
    if (paths.empty()) {
      EXPECT_LT(test::sphere_distance(p, q), 7 * table.spacing()) << "seed " << kSeed << " trial " << trial;
      continue;
    }
    ++answered;
    EXPECT_NEAR(paths[0].length, test::sphere_distance(p, q), 0.04 * paths[0].length)
        << "seed " << kSeed << " trial " << trial;
    EXPECT_TRUE(std::is_sorted(paths.begin(), paths.end(),
                               [](const StartPath& a, const StartPath& b) { return a.length < b.length; }));
    for (const StartPath& path : paths) {
      EXPECT_EQ(path.points.col(0), p);
      EXPECT_EQ(path.points.rightCols(1), q);
    }
  }
  EXPECT_GT(answered, 100);
}

TEST(DistanceTable, DistancesAreThoseOfMarches) {
  for (const char* formula :
       {"x^2 + 4y^2 + 2z^2 = 1", "(x^2+y^2+z^2+0.84)^2 = 4(x^2+y^2)", "x^2+y^2 = 0.5; z^2+w^2 = 0.5"}) {
    const Surface surface = parse_surface(formula);
    const double size = surface.dim() == 3 ? 0.12 : 0.17;
    const DistanceTable table(surface, cells_in_box(surface, size, 1.8), 120);
    SurfaceCells cells = cells_in_box(surface, size, 1.8);
    Index compared = 0;
    for (const Index from : {Index{3}, table.num_landmarks() / 2}) {
      const Vector p = table.landmark(from);
      const DistanceField field = march(surface, cells, p);
      for (Index l = 0; l < table.num_landmarks(); ++l) {
        const std::vector<StartPath> paths = table.start_paths(p, table.landmark(l), {.max_paths = 1});
        if (paths.empty()) continue;
        const double marched = distance_at(surface, cells, field, table.landmark(l))(0);
        // Up to the detour past a landmark.
        EXPECT_NEAR(paths[0].length, marched, 0.04 * marched) << formula << ", landmarks " << from << " and " << l;
        ++compared;
      }
    }
    EXPECT_GT(compared, 60) << formula;
  }
}

TEST(DistanceTable, IsTheSameInAllUnits) {
  const Vector p = Eigen::Vector3d(0.6, 0, 0.8);
  const Vector q = Eigen::Vector3d(-0.48, 0.8, -0.36).normalized();
  for (const double unit : {1e-25, 1.0, 1e25}) {
    const Surface sphere = parse_surface("x^2+y^2+z^2 = r^2", {.parameters = {{"r", unit}}});
    const DistanceTable table(sphere, cells_in_box(sphere, 0.18 * unit, 1.3 * unit), 150);
    const std::vector<StartPath> paths = table.start_paths(p * unit, q * unit);
    ASSERT_FALSE(paths.empty()) << unit;
    EXPECT_NEAR(paths[0].length / unit, test::sphere_distance(p, q), 0.04 * test::sphere_distance(p, q)) << unit;
  }
}

TEST(DistanceTable, OppositePointsHaveSeveralStarts) {
  const Surface sphere = test::unit_sphere();
  const DistanceTable table(sphere, cells_in_box(sphere, 0.18, 1.3), 200);
  const Vector p = Eigen::Vector3d(0.6, 0, 0.8);
  EXPECT_GE(table.start_paths(p, -p).size(), 4U);
  EXPECT_EQ(table.start_paths(p, -p, {.max_paths = 2}).size(), 2U);
}

// The two sides of a plate: the ways over the top and under the bottom are a plate's thickness apart.
TEST(DistanceTable, TellsTheSidesOfAPlateApart) {
  const Surface plate = test::ellipsoid(1, 1, 0.2);
  const DistanceTable table(plate, cells_in_box(plate, 0.06, 1.3), 300);
  const std::vector<StartPath> paths =
      table.start_paths(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), {.excess = 0.03, .max_paths = 16});
  bool over = false;
  bool under = false;
  for (const StartPath& path : paths) {
    const auto middle = path.points.col(path.points.cols() / 2);
    over = over || middle(2) > 0.05;
    under = under || middle(2) < -0.05;
  }
  EXPECT_TRUE(over);
  EXPECT_TRUE(under);
}

TEST(DistanceTable, ThreadsDoNotChangeIt) {
  const Surface torus = test::torus();
  const DistanceTable one(torus, cells_in_box(torus, 0.15, 1.6), 100, Context{.threads = 1});
  const DistanceTable two(torus, cells_in_box(torus, 0.15, 1.6), 100, Context{.threads = 2});
  const Vector p = Eigen::Vector3d(1.4, 0, 0);
  const Vector q = Eigen::Vector3d(-1, 0, 0.4);
  const std::vector<StartPath> a = one.start_paths(p, q);
  const std::vector<StartPath> b = two.start_paths(p, q);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].points, b[i].points);
}

TEST(DistanceTable, RefusesWhatItCannotUse) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(0, 0, 1);
  EXPECT_THROW(DistanceTable(sphere, SurfaceCells::lazy(sphere, p, 0.2), 10), InvalidArgument);
  EXPECT_THROW(DistanceTable(sphere, cells_in_box(sphere, 0.2, 1.3), 0), InvalidArgument);
  EXPECT_THROW(DistanceTable(sphere, cells_in_box(sphere, 0.05, 1.3), 1000, Context{.memory_limit = 1 << 20}),
               OutOfMemory);
}

}  // namespace
}  // namespace taut
