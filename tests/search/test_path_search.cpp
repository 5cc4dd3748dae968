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

// On a great circle the tangents are the ends turned by a right angle.
TEST(PathSearch, APathHasItsDirectionsAtBothEnds) {
  const Eigen::Vector3d p(0, 0, 1);
  const Eigen::Vector3d q(0, 0.6, -0.8);
  const PathResult path = shortest_path(test::unit_sphere(), p, q);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_LT((path.start_direction - Eigen::Vector3d(0, 1, 0)).norm(), 1e-9);
  EXPECT_LT((path.end_direction - Eigen::Vector3d(0, -0.8, -0.6)).norm(), 1e-9);
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

// On a parabolic cylinder the way round the fold leaves the first window; no geodesic from the start is shorter.
TEST(PathSearch, OnASurfaceWithoutEndTheFanGoesAsFarAsThePath) {
  const PathResult path =
      shortest_path(parse_surface("x=10*z^2", {.dim = 3}), Eigen::Vector3d(10, 0, 1), Eigen::Vector3d(10, 0, -1));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_EQ(path.rungs.back().rung, Rung::fan);
  EXPECT_TRUE(path.unique);
  // Twice the arc of x = 10 z^2 from z = 0 to 1.
  const double arc = std::sqrt(401.0) / 2 + std::asinh(20.0) / 40;
  EXPECT_NEAR(path.length, 2 * arc, 1e-8 * arc);
}

Surface narrow_neck() {
  return parse_surface("x^2+y^2=z^2+0.001").with_box({Vector::Constant(3, -1.5), Vector::Constant(3, 1.5)});
}

// The two ways past a neck narrower than a cell differ by 0.2 %. Truth: Clairaut's integrals, Simpson's rule on 4,000
// intervals.
TEST(PathSearch, PastANarrowNeckTheFanTellsWhichWay) {
  const Surface hyperboloid = narrow_neck();
  const PathResult path =
      shortest_path(hyperboloid, Eigen::Vector3d(0.6984953274110905, 0.6695554451247852, 0.9670575042423154),
                    Eigen::Vector3d(-0.8380504514615447, -1.0520671595463014, -1.34468355660011));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, 3.26757368026, 1e-9);
  EXPECT_EQ(path.rungs.back().rung, Rung::fan);
  EXPECT_TRUE(path.unique);
}

// Through the neck all the way round: both ways are as short, by symmetry.
TEST(PathSearch, TheFanSeesThatTwoWaysAreAsShort) {
  const Surface hyperboloid = narrow_neck();
  const double r = std::sqrt(1.001);
  const PathResult path = shortest_path(hyperboloid, Eigen::Vector3d(r, 0, 1), Eigen::Vector3d(-r, 0, -1));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_FALSE(path.unique);
  EXPECT_TRUE(path.tied);
}

// Cells would have to be smaller than the gap; every geodesic from the start comes back to it.
TEST(PathSearch, OfTwoShellsTheFanStaysOnOne) {
  const Surface shells = parse_surface("(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1.0201)=0");
  const PathResult path = shortest_path(shells, Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1.01, 0));
  EXPECT_EQ(path.status, Status::disconnected) << path.message;
  EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::apart_by_fan);
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
