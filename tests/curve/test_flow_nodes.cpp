#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "curve/osculating_circles.hpp"
#include "support/surfaces.hpp"
#include "taut/curve/flow.hpp"

// How nodes are spread: evenly (sec. 4 of the paper) or in proportion to the radius of curvature (its Appendix II).

namespace taut {
namespace {

/// Half of the ellipse with semi-axes 3 and 1 in which the ellipsoid (3, 10, 1) is cut by y = 0: a geodesic by
/// symmetry, its radius of curvature from 1/3 at the vertex to 9 at its ends.
Points half_ellipse(double wiggle) {
  constexpr Index m = 40;
  Points nodes(3, m + 1);
  for (Index i = 0; i <= m; ++i) {
    const double t = std::numbers::pi * static_cast<double>(i) / m - std::numbers::pi / 2;
    nodes.col(i) << 3 * std::cos(t), i == 0 || i == m ? 0 : wiggle * std::sin(9 * t), std::sin(t);
  }
  nodes.col(0) << 0, 0, -1;
  nodes.col(m) << 0, 0, 1;
  return nodes;
}

/// Radius of curvature of that ellipse at (x, z): (9 z^2 + x^2 / 9)^(3/2) / 3.
double radius_at(const Vector& p) { return std::pow(9 * p(2) * p(2) + p(0) * p(0) / 9, 1.5) / 3; }

/// Largest over smallest eps_i / r_i.
double variation(const FlowResult& result) {
  const Vector lengths = detail::interval_lengths(result.points);
  double least = 1e300;
  double most = 0;
  for (Index i = 0; i < lengths.size(); ++i) {
    const double ratio = lengths(i) / radius_at((result.points.col(i) + result.points.col(i + 1)) / 2);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  return most / least;
}

TEST(FlowNodes, ByCurvatureTheIntervalsOverTheirRadiiAreOneConstant) {
  const Surface surface = test::ellipsoid(3, 10, 1);
  const FlowResult even = correct_flow(surface, half_ellipse(0.02), {.spacing = 0.1});
  const FlowResult by_radius =
      correct_flow(surface, half_ellipse(0.02), {.spacing = 0.1, .nodes = NodeSpread::curvature});
  ASSERT_EQ(even.status, Status::ok) << even.reason;
  ASSERT_EQ(by_radius.status, Status::ok) << by_radius.reason;
  EXPECT_GT(variation(even), 20) << "radii differ by a factor of 27";
  EXPECT_LT(variation(by_radius), 1.5);
  EXPECT_LE(even.summary.longest_interval, 0.1);
  EXPECT_LE(by_radius.summary.longest_interval, 0.1) << "eps_E is the most in both";
}

TEST(FlowNodes, ByCurvatureFewerNodesGiveTheSameError) {
  const Surface surface = test::ellipsoid(3, 10, 1);
  const FlowResult even = correct_flow(surface, half_ellipse(0.02));
  const FlowResult by_radius = correct_flow(surface, half_ellipse(0.02), {.nodes = NodeSpread::curvature});
  ASSERT_EQ(even.status, Status::ok) << even.reason;
  ASSERT_EQ(by_radius.status, Status::ok) << by_radius.reason;
  EXPECT_NEAR(by_radius.summary.error_sum / by_radius.length, 2e-5, 1e-5);
  EXPECT_LT(1.5 * static_cast<double>(by_radius.summary.num_intervals),
            static_cast<double>(even.summary.num_intervals));
  EXPECT_NEAR(even.length, by_radius.length, even.length_error + by_radius.length_error);
}

TEST(FlowNodes, EvenMeansEven) {
  const FlowResult result = correct_flow(test::torus(1, 0.4),
                                         [] {
                                           Points start(3, 13);
                                           for (Index i = 0; i < 13; ++i) {
                                             const double t = 0.1 * static_cast<double>(i);
                                             start.col(i) << 1.4 * std::cos(t), 1.4 * std::sin(t), 0;
                                           }
                                           return start;
                                         }(),
                                         {.spacing = 0.02});
  ASSERT_EQ(result.status, Status::ok) << result.reason;
  const Vector lengths = detail::interval_lengths(result.points);
  EXPECT_LT(lengths.maxCoeff() / lengths.minCoeff(), 1.01);
}

}  // namespace
}  // namespace taut
