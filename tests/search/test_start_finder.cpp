// Starts on surfaces whose ways are plain to see.
#include "search/start_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "curve/polyline.hpp"
#include "support/surfaces.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

struct Found {
  detail::Starts starts;
  bool apart = false;
};

Found find(const Surface& surface, const Vector& p, const Vector& q, const PathOptions& options = {}) {
  const Context context;
  detail::StartFinder finder(surface, options, context);
  finder.prepare(detail::chord(p, q));
  Found found{finder.find(p, q, 0)};
  if (found.starts.paths.empty() && found.starts.cells) found.apart = finder.apart(*found.starts.cells, 0, p, q);
  return found;
}

TEST(StartFinder, OnePlainWayIsOneStart) {
  const Vector p = Eigen::Vector3d(0, 0, 1);
  const Vector q = Eigen::Vector3d(0, 0.6, 0.8);
  const Found found = find(test::unit_sphere(), p, q);
  ASSERT_EQ(found.starts.paths.size(), 1U);
  const detail::StartPath& start = found.starts.paths.front();
  EXPECT_NEAR(start.length, std::acos(0.8), 0.05);
  EXPECT_EQ(start.points.col(0), p);
  EXPECT_EQ(start.points.rightCols(1), q);
  EXPECT_FALSE(found.starts.doubts.any());
}

// A little less than half-way round a cylinder: there are two ways, and the other one is not 15 % longer.
TEST(StartFinder, BothWaysRoundACylinderAreFoundShortestFirst) {
  const Surface cylinder = parse_surface("x^2+y^2=1", {.dim = 3, .domain = {"z >= -1", "z <= 1"}});
  const double angle = pi - 0.1;
  const Vector q = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  const Found found = find(cylinder, Eigen::Vector3d(1, 0, 0), q);
  ASSERT_GE(found.starts.paths.size(), 2U);
  EXPECT_NEAR(found.starts.paths[0].length, angle, 0.05);
  EXPECT_NEAR(found.starts.paths[1].length, 2 * pi - angle, 0.05);
  const auto half_way_y = [&](std::size_t i) {
    const Points& points = found.starts.paths[i].points;
    return points(1, points.cols() / 2);
  };
  EXPECT_GT(half_way_y(0), 0.5);
  EXPECT_LT(half_way_y(1), -0.5);
}

TEST(StartFinder, NoWayLeadsFromOneSphereToAnotherAndCellsProveIt) {
  const Surface two = parse_surface("(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0");
  const Found found = find(two, Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(3, 0, 0));
  EXPECT_TRUE(found.starts.paths.empty());
  EXPECT_TRUE(found.apart);
}

TEST(StartFinder, AMarchBetweenCellCentresTellsNoRivals) {
  const Found found =
      find(test::unit_sphere(), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0.6, -0.8), {.march = MarchMethod::axis});
  ASSERT_EQ(found.starts.paths.size(), 1U);
  EXPECT_EQ(found.starts.doubts, Doubts{Doubt::rivals_not_sought});
}

TEST(StartFinder, WithoutCellsRandomWaysAreSaidToBeSo) {
  const Surface sphere = parse_surface("x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1");
  const Vector p = Vector::Unit(7, 0);
  EXPECT_EQ(find(sphere, p, Vector(Vector::Unit(7, 1))).starts.doubts, Doubts{Doubt::rivals_not_sought});
  EXPECT_EQ(find(sphere, p, Vector(Vector::Unit(7, 1)), {.all = true}).starts.doubts, Doubts{Doubt::random_search});
}

}  // namespace
}  // namespace taut
