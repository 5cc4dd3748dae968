// Which rungs of the ladder a pair climbs, and what they leave.
#include "search/path_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

std::vector<Rung> rungs(const PathResult& path) {
  std::vector<Rung> climbed;
  for (const RungReport& report : path.rungs) climbed.push_back(report.rung);
  return climbed;
}

TEST(PathSearch, APlainPairTakesOneRung) {
  const PathResult path = shortest_path(test::unit_sphere(), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0.6, -0.8));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_EQ(rungs(path), std::vector{Rung::fields});
  EXPECT_EQ(path.rungs[0].length, path.length);
  EXPECT_GT(path.rungs[0].num_cells, 0);
  EXPECT_FALSE(path.rungs[0].doubts.any());
  EXPECT_TRUE(path.unique);
}

TEST(PathSearch, TheSamePointNeedsNone) {
  const PathResult path = shortest_path(test::unit_sphere(), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, 1));
  EXPECT_TRUE(path.rungs.empty());
  EXPECT_TRUE(path.unique);
}

TEST(PathSearch, InManyDimensionsOnlyWalksAreTried) {
  const Surface sphere = parse_surface("x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1");
  const PathResult path = shortest_path(sphere, Vector::Unit(7, 0), Vector::Unit(7, 1));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_EQ(rungs(path), std::vector{Rung::walks});
  EXPECT_TRUE(path.doubts.any());
}

// Cells of a given size that are coarser than the surface bends: a part of the box gets finer ones.
TEST(PathSearch, CoarseCellsAreLookedAtCloser) {
  const PathResult path =
      shortest_path(test::ellipsoid(1, 1, 0.3), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 0.3), {.cell = 0.5});
  ASSERT_EQ(path.status, Status::ok) << path.message;
  const std::vector<Rung> climbed = rungs(path);
  ASSERT_FALSE(climbed.empty());
  EXPECT_EQ(climbed.front(), Rung::fields);
  EXPECT_EQ(climbed.back(), Rung::closer);
  EXPECT_TRUE(path.rungs.front().doubts.has(Doubt::coarse_cells));
  EXPECT_LT(path.cell, 0.5);
}

// On a parabolic cylinder the way round the fold leaves the first window.
TEST(PathSearch, ASurfaceWithoutEndIsLookedAtThroughWiderWindows) {
  const PathResult path =
      shortest_path(parse_surface("x=10*z^2", {.dim = 3}), Eigen::Vector3d(10, 0, 1), Eigen::Vector3d(10, 0, -1));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_EQ(path.rungs.back().rung, Rung::wider);
  // Twice the arc of x = 10 z^2 from z = 0 to 1.
  const double arc = std::sqrt(401.0) / 2 + std::asinh(20.0) / 40;
  EXPECT_NEAR(path.length, 2 * arc, 1e-8 * arc);
}

TEST(PathSearch, OverEdgesTheGraphOfFacesAnswers) {
  const PathResult path = shortest_path(parse_surface("max(abs(x),max(abs(y),abs(z)))=1"), Eigen::Vector3d(1, 0, 0.5),
                                        Eigen::Vector3d(0, 0.25, 1));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_EQ(rungs(path), std::vector{Rung::faces});
  EXPECT_NEAR(path.length, std::hypot(1.5, 0.25), 1e-9);
}

}  // namespace
}  // namespace taut
