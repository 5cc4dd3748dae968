#include "taut/curve/spectral_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

/// Quarter of the unit circle in space, m points at uneven angles.
Points quarter(Index m) {
  Points points(3, m);
  for (Index i = 0; i < m; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(m - 1);
    const double angle = std::numbers::pi / 2 * t * (1 + t * (1 - t));
    points.col(i) << std::cos(angle), std::sin(angle), 0;
  }
  return points;
}

TEST(EvenlySpaced, ArcLengthsConvergeFasterThanTheChords) {
  double before = 0;
  for (const Index m : {20, 40, 80}) {
    const double error = std::abs(arc_lengths(quarter(m))(m - 1) - std::numbers::pi / 2);
    if (before > 0) {  // the chords' own would fall by 4
      EXPECT_LT(error, before / 7) << m;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-7);
}

TEST(EvenlySpaced, ACornerIsNoArc) {
  Points corner(2, 3);
  corner << 0, 1, 1, 0, 0, 1;
  EXPECT_EQ(arc_lengths(corner), Eigen::Vector3d(0, 1, 2));
}

TEST(EvenlySpaced, PointsLieOnTheSurfaceAtEqualDistances) {
  const Surface sphere = parse_surface("x^2+y^2+z^2=1");
  const Points points = evenly_spaced(sphere, quarter(60), 10);
  ASSERT_EQ(points.cols(), 10);
  EXPECT_EQ(points.col(0), quarter(60).col(0));
  EXPECT_EQ(points.col(9), quarter(60).col(59));
  for (Index i = 0; i < 10; ++i) {
    EXPECT_NEAR(points.col(i).norm(), 1, 1e-14);
    EXPECT_NEAR(std::atan2(points(1, i), points(0, i)), std::numbers::pi / 18 * static_cast<double>(i), 2e-6);
  }
  EXPECT_THROW((void)evenly_spaced(sphere, quarter(60), 1), InvalidArgument);
  EXPECT_THROW((void)evenly_spaced(sphere, quarter(60).leftCols(1), 5), InvalidArgument);
}

}  // namespace
}  // namespace taut
