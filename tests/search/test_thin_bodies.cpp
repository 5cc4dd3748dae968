// Bodies so thin that no cells tell their sheets apart: the way from one side to the other is found by geodesics to all
// sides, which turn round the rim.

#include <gtest/gtest.h>

#include <cmath>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(ThinBodies, OverTheRimOfAWafer) {
  const double c = 0.005;
  const Surface wafer = parse_surface("x^2+y^2+z^2/0.005^2=1");
  const Eigen::Vector3d top(0.5, 0, c * std::sqrt(0.75));
  const Eigen::Vector3d below(0.5, 0, -c * std::sqrt(0.75));
  const PathResult path = shortest_path(wafer, top, below);
  const double truth = 1.000153383953867757;  // an elliptic integral, with 25 digits
  EXPECT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, truth, path.length_error);
  EXPECT_LE(path.length_error, 1e-9);
  EXPECT_FALSE(path.unique);  // geodesics to some sides are not all there are
}

}  // namespace
}  // namespace taut
