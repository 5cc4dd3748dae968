#include "surface/rbf/stabbed_balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/clouds.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {
namespace {

TEST(StabbedBalls, AreThoseThatHoldAPoint) {
  test::Uniform uniform(3);
  constexpr Index kBalls = 500;
  Points centres(3, kBalls);
  Vector radius(kBalls);
  for (double& c : centres.reshaped()) c = uniform();
  for (double& r : radius) r = 0.01 + 0.2 * std::pow(uniform(), 4);
  const StabbedBalls balls(centres, radius);
  std::vector<Index> found;
  for (int k = 0; k < 200; ++k) {
    const Vector x{{1.2 * uniform() - 0.1, 1.2 * uniform() - 0.1, 1.2 * uniform() - 0.1}};
    const Vector distance = (centres.colwise() - x).colwise().norm();
    balls.stabbed(x.data(), found);
    std::ranges::sort(found);
    std::vector<Index> expected;
    for (Index i = 0; i < kBalls; ++i) {
      if (distance(i) <= radius(i)) expected.push_back(i);
    }
    EXPECT_EQ(found, expected);
    Index nearest = 0;
    (void)distance.minCoeff(&nearest);
    EXPECT_EQ(balls.nearest(x.data()), nearest);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vector nowhere{{0.5, nan, 0.5}};
  EXPECT_EQ(balls.nearest(nowhere.data()), -1);
  balls.stabbed(nowhere.data(), found);
  EXPECT_TRUE(found.empty());
  const Vector low = Vector::Zero(3);
  const Vector high = Vector::Ones(3);
  EXPECT_FALSE(balls.near_box(low.data(), high.data(), 100, found));
  EXPECT_TRUE(balls.near_box(low.data(), high.data(), 1000, found));
  EXPECT_EQ(found.size(), 500U);
}

}  // namespace
}  // namespace taut::detail
