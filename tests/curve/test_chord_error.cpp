#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "curve/chord_error.hpp"

// Appendix II of the paper on curves whose error is known in closed form.

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;

/// An arc of `angle` radians of a circle of this radius, in m chords.
Points arc(double radius, double angle, Index m) {
  Points nodes(3, m + 1);
  for (Index i = 0; i <= m; ++i) {
    const double t = angle * static_cast<double>(i) / static_cast<double>(m);
    nodes.col(i) << radius * std::cos(t), 0.3, radius * std::sin(t);
  }
  return nodes;
}

TEST(ChordError, OnACircleBothModelsAreTheExactError) {
  for (const double radius : {0.01, 1.0, 70.0}) {
    for (const Index m : {4, 30, 1000}) {
      const double angle = 1.5 * kPi;
      const double step = angle / static_cast<double>(m);
      const double chord = 2 * radius * std::sin(step / 2);
      const FlowSummary summary = detail::summarise(arc(radius, angle, m));
      const double error = radius * angle - static_cast<double>(m) * chord;
      EXPECT_NEAR(summary.cst, chord / radius, 1e-9 * chord / radius);
      EXPECT_NEAR(summary.error_a1, error, 1e-6 * error) << "(A1), m = " << m;
      EXPECT_NEAR(summary.error_sum, error, 1e-6 * error) << "the sum, m = " << m;
      EXPECT_NEAR(summary.length, static_cast<double>(m) * chord, 1e-12 * radius);
      EXPECT_NEAR(summary.mean_interval, chord, 1e-12 * radius);
      EXPECT_NEAR(summary.longest_interval, chord, 1e-12 * radius);
      EXPECT_EQ(summary.num_intervals, m);
    }
  }
}

// A straight piece and an arc: the sum sees that only the arc errs; one Cst for both cannot.
TEST(ChordError, OneCstForTheWholeCurveIsAnApproximation) {
  const Index m = 200;
  const Points bend = arc(1, kPi / 2, m);
  Points nodes(3, 2 * m + 1);
  for (Index i = 0; i < m; ++i) nodes.col(i) << 1, 0.3, (static_cast<double>(i - m)) * kPi / 2 / static_cast<double>(m);
  nodes.rightCols(m + 1) = bend;
  const FlowSummary summary = detail::summarise(nodes);
  const double error = kPi / 2 - static_cast<double>(m) * 2 * std::sin(kPi / 4 / static_cast<double>(m));
  EXPECT_NEAR(summary.error_sum, error, 0.01 * error);
  EXPECT_NEAR(summary.error_a1, error, 0.01 * error) << "root mean square: the same to second order";
  EXPECT_LT(summary.cst, 0.72 * kPi / 2 / static_cast<double>(m));
}

TEST(ChordError, TheTimeModelTakesKNodesByNodes) {
  FlowSummary summary = detail::summarise(arc(2, kPi, 50));
  detail::set_seconds(0.25, summary);
  EXPECT_DOUBLE_EQ(summary.seconds, 0.25);
  EXPECT_DOUBLE_EQ(summary.seconds_per_node, 0.25 / 50);  // K
  // (A2) with the error that (A1) gives is K m: on a circle the sum is that error.
  EXPECT_NEAR(summary.seconds_a2, 0.25, 1e-6);
}

TEST(ChordError, AStraightLineTakesNoTimeByA2) {
  Points line(2, 5);
  for (Index i = 0; i < 5; ++i) line.col(i) << static_cast<double>(i), 0;
  FlowSummary summary = detail::summarise(line);
  detail::set_seconds(1, summary);
  EXPECT_EQ(summary.error_a1, 0);
  EXPECT_EQ(summary.error_sum, 0);
  EXPECT_EQ(summary.seconds_a2, 0);
}

}  // namespace
}  // namespace taut
