// Two hills in a row, three of four ways round them known: the fourth is spliced together.
#include "search/splices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "curve/polyline.hpp"
#include "support/surfaces.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double kWide = 0.3;

/// A way from (0, 0) to (4, 0) that passes a hill at x = 1 and another at x = 3, each on the side of y given.
PathCandidate way(double first, double second, double height = 0) {
  constexpr Index kPoints = 201;
  PathCandidate result;
  result.points.resize(3, kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    const double x = 4.0 * static_cast<double>(i) / (kPoints - 1);
    result.points.col(i) << x, (x < 2 ? first : second) * kWide * std::abs(std::sin(pi * x / 2)), height;
  }
  result.length = detail::polyline_length(result.points);
  return result;
}

double side(const detail::StartPath& path, double x) {
  Index nearest = 0;
  (path.points.row(0).array() - x).abs().minCoeff(&nearest);
  return path.points(1, nearest);
}

TEST(Splices, TheMissingWayIsFound) {
  const Surface plane = parse_surface("z=0", {.dim = 3});
  const std::vector<PathCandidate> known = {way(1, 1), way(-1, -1), way(-1, 1)};
  const std::vector<detail::StartPath> found = detail::splices(plane, known, 1.02 * known[0].length);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(side(found[0], 1), 0.8 * kWide);
  EXPECT_LT(side(found[0], 3), -0.8 * kWide);
  EXPECT_EQ(found[0].points.col(0), known[0].points.col(0));
  EXPECT_LT((found[0].points.rightCols(1) - known[0].points.rightCols(1)).norm(), 1e-15);
  EXPECT_NEAR(found[0].length, known[0].length, 0.02 * known[0].length);
  EXPECT_TRUE(detail::splices(plane, known, 0.9 * known[0].length).empty());
}

TEST(Splices, NothingIsMissingWhereAllWaysAreKnown) {
  const Surface plane = parse_surface("z=0", {.dim = 3});
  const std::vector<PathCandidate> known = {way(1, 1), way(-1, -1), way(-1, 1), way(1, -1)};
  EXPECT_TRUE(detail::splices(plane, known, 1.1 * known[0].length).empty());
  EXPECT_TRUE(detail::splices(plane, {way(1, 1)}, 10).empty());
  EXPECT_TRUE(detail::splices(plane, {way(1, 1), way(0.9, 0.9)}, 10).empty());  // beside each other all the way
}

TEST(Splices, DoNotStepThroughAThinBody) {
  const Surface plate = parse_surface("z^2=0.0001", {.dim = 3});
  const std::vector<PathCandidate> known = {way(1, 1, 0.01), way(-1, -1, -0.01)};
  EXPECT_TRUE(detail::splices(plate, known, 1.1 * known[0].length).empty());
}

}  // namespace
}  // namespace taut
