#include "strata/border_band.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {
namespace {

constexpr double kPi = std::numbers::pi;

Surface cut(const char* formula, const char* domain) {
  FormulaOptions options;
  options.dim = 3;
  options.domain = {domain};
  return parse_surface(formula, options);
}

/// Tangents and an arc: 2 sqrt 3 + pi / 3 round the unit disc, on the side where the start is.
TEST(BorderBand, GoesRoundADisc) {
  const Surface plane = cut("z=0", "x^2+y^2>=1");
  for (const double side : {1.0, -1.0}) {
    Points start(3, 5);
    start << -2, -1.2, 0.1, 1.3, 2, 0, side * 1.1, side * 1.6, side * 0.8, 0, 0, 0, 0, 0, 0;
    const BorderBand band = pull_taut(plane, start, 0.1, {});
    EXPECT_TRUE(band.settled);
    const double truth = 2 * std::sqrt(3) + kPi / 3;
    EXPECT_NEAR(band.length, truth, 1e-6);
    EXPECT_LE(std::abs(band.length - truth), band.error + 1e-9);
    EXPECT_GT(side * band.points(1, band.points.cols() / 2), 0.9);
    EXPECT_LT(band.outside, 1e-4);
    // It touches from 60 to 120 degrees: a sixth of the length is pi / 3.
    const auto touching = std::ranges::count_if(band.touching, [](int m) { return m >= 0; });
    EXPECT_NEAR(static_cast<double>(touching) / static_cast<double>(band.points.cols()), kPi / 3 / truth, 0.01);
  }
}

/// A cap of a sphere is forbidden: along its rim, pi sqrt(3) / 2 between opposite points of it.
TEST(BorderBand, FollowsTheRimOfACap) {
  const Surface sphere = cut("x^2+y^2+z^2=1", "z<=0.5");
  Points start(3, 41);
  const double r = std::sqrt(0.75);
  for (Index j = 0; j < 41; ++j) {
    const double angle = kPi * static_cast<double>(j) / 40;
    const double z = 0.5 - 0.3 * std::sin(angle);
    const double wide = std::sqrt(1 - z * z);
    start.col(j) << wide * std::cos(angle), wide * std::sin(angle), z;
  }
  const BorderBand band = pull_taut(sphere, start, 0.1, {});
  EXPECT_TRUE(band.settled);
  EXPECT_NEAR(band.length, kPi * r, 2e-6);
}

/// Free, it is the geodesic.
TEST(BorderBand, IsAGeodesicAwayFromBorders) {
  const Surface sphere = cut("x^2+y^2+z^2=1", "z>=-2");
  Points start(3, 4);
  start << 1, 0.8, 0.5, 0, 0, 0.5, 0.8, 1, 0, 0.33166, 0.33166, 0;
  const BorderBand band = pull_taut(sphere, start, 0.2, {});
  EXPECT_TRUE(band.settled);
  EXPECT_NEAR(band.length, kPi / 2, 1e-8);
  EXPECT_TRUE(std::ranges::all_of(band.touching, [](int m) { return m < 0; }));
}

/// A slit narrower than the first parts is not jumped.
TEST(BorderBand, DoesNotJumpASlit) {
  // Outside is a flat ellipse across the straight line, 0.01 wide and 2 long.
  const Surface plane = cut("z=0", "(x/0.01)^2+y^2>=1");
  Points start(3, 4);
  start << -1, -0.05, 0.05, 1, 0, 1.1, 1.1, 0, 0, 0, 0, 0;
  const BorderBand band = pull_taut(plane, start, 0.1, {});
  EXPECT_GT(band.length, 2 * std::sqrt(2) - 1e-3);
  EXPECT_LT(band.length, 2.84);
}

}  // namespace
}  // namespace taut::detail
