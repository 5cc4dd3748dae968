#include "march/start_paths.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "support.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using namespace detail;

using std::numbers::pi;

std::vector<StartPath> ways(const Surface& surface, SurfaceCells& cells, const Vector& p, const Vector& q,
                            const StartPathOptions& options = {}) {
  const DistanceField from_p = march(surface, cells, p);
  const DistanceField from_q = march(surface, cells, q);
  return start_paths(surface, cells, from_p, from_q, options);
}

TEST(StartPaths, OneForAnOrdinaryPair) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(1, 0, 0);
  const Vector q = Eigen::Vector3d(0, 0.6, 0.8);
  SurfaceCells cells = test::all_cells(sphere, p, 0.08);
  const std::vector<StartPath> paths = ways(sphere, cells, p, q);
  ASSERT_EQ(paths.size(), 1U);
  EXPECT_NEAR(paths[0].length, pi / 2, 0.01);
  EXPECT_EQ(paths[0].points.col(0), p);
  EXPECT_EQ(paths[0].points.rightCols(1), q);
}

// On the way between opposite points every meridian is as short: starts must go out in many directions.
TEST(StartPaths, SpreadOverTheBisectorOfOppositePoints) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(0, 0, 1);
  SurfaceCells cells = test::all_cells(sphere, p, 0.08);
  const std::vector<StartPath> paths = ways(sphere, cells, p, -p);
  EXPECT_GE(paths.size(), 4U);
  for (const StartPath& path : paths) EXPECT_NEAR(path.length, pi, 0.03);
}

TEST(StartPaths, BothWaysRoundATorusWhenAllAreWanted) {
  const Surface torus = test::torus(1, 0.4);
  const Vector p = Eigen::Vector3d(0.6, 0, 0);  // on the inner equator, a geodesic of length 0.6 * 2 pi
  const Vector q = 0.6 * Eigen::Vector3d(std::cos(2.0), std::sin(2.0), 0);
  SurfaceCells cells = test::all_cells(torus, p, 0.08);
  EXPECT_EQ(ways(torus, cells, p, q).size(), 1U);
  const auto all = ways(torus, cells, p, q, {.excess = std::numeric_limits<double>::infinity(), .max_paths = 64});
  const auto is_near = [&](double length) {
    return std::any_of(all.begin(), all.end(),
                       [&](const StartPath& path) { return std::abs(path.length / length - 1) < 0.02; });
  };
  EXPECT_TRUE(is_near(0.6 * 2));
  EXPECT_TRUE(is_near(0.6 * (2 * pi - 2)));
}

TEST(StartPaths, EmptyBetweenComponents) {
  const Surface spheres = parse_surface("(x^2+y^2+z^2-1)*((x-3)^2+y^2+z^2-1)=0");
  const Vector p = Eigen::Vector3d(0, 0, 1);
  const Vector q = Eigen::Vector3d(3, 0, 1);
  Points seeds(3, 2);
  seeds << p, q;
  SurfaceCells cells = SurfaceCells::lazy(spheres, seeds, 0.1);
  for (Index i = 0; i < cells.num_cells(); ++i) cells.expand(i);
  EXPECT_TRUE(ways(spheres, cells, p, q).empty());
}

TEST(StartPaths, RefusesFieldsThatDoNotFit) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(0, 0, 1);
  SurfaceCells cells = test::all_cells(sphere, p, 0.2);
  const DistanceField convergent = march(sphere, cells, p);
  const DistanceField dijkstra = march(sphere, cells, -p, {.method = MarchMethod::dijkstra});
  EXPECT_THROW((void)start_paths(sphere, cells, convergent, dijkstra), InvalidArgument);
  EXPECT_THROW((void)start_paths(sphere, cells, convergent, convergent, {.excess = -1}), InvalidArgument);
  EXPECT_THROW((void)start_paths(sphere, cells, convergent, convergent, {.max_paths = 0}), InvalidArgument);
  EXPECT_THROW((void)start_paths(sphere, cells, convergent, convergent, {.spread = 0}), InvalidArgument);
}

}  // namespace
}  // namespace taut
