// Rivals on hand-made input: arcs from (-1, 0) to (1, 0), told apart and put in order.
#include "search/candidates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "curve/polyline.hpp"
#include "search/contender.hpp"

namespace taut {
namespace {

/// A parabola of a given height over the chord, with its length by the points.
PathCandidate arc(double height, double error = 1e-9) {
  constexpr Index kPoints = 101;
  PathCandidate result;
  result.points.resize(2, kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    const double x = -1 + 2.0 * static_cast<double>(i) / (kPoints - 1);
    result.points.col(i) << x, height * (1 - x * x);
  }
  result.length = detail::polyline_length(result.points);
  result.length_error = error;
  return result;
}

std::vector<PathCandidate> filed(const std::vector<PathCandidate>& in_turn) {
  std::vector<PathCandidate> candidates;
  for (const PathCandidate& one : in_turn) detail::add_candidate(candidates, one);
  return candidates;
}

TEST(Candidates, StandShortestFirstInWhateverOrderTheyCome) {
  const PathCandidate low = arc(0.1), middle = arc(0.2), high = arc(0.4);
  for (const auto& in_turn : {std::vector{low, middle, high}, {high, low, middle}, {middle, high, low}}) {
    const std::vector<PathCandidate> candidates = filed(in_turn);
    ASSERT_EQ(candidates.size(), 3U);
    EXPECT_EQ(candidates[0].length, low.length);
    EXPECT_EQ(candidates[1].length, middle.length);
    EXPECT_EQ(candidates[2].length, high.length);
  }
}

TEST(Candidates, OneCurveFoundTwiceIsOneAndTheSurerCounts) {
  const std::vector<PathCandidate> candidates = filed({arc(0.2, 1e-6), arc(0.2, 1e-10), arc(0.2, 1e-8)});
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].length_error, 1e-10);
  EXPECT_TRUE(detail::first_is_unique(candidates, 1e-9));
}

TEST(Candidates, AMirrorImageIsAsShortAndAnotherCurve) {
  const std::vector<PathCandidate> candidates = filed({arc(0.2), arc(-0.2)});
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_FALSE(detail::first_is_unique(candidates, 1e-9));
}

TEST(Candidates, WithinItsErrorASecondOneMayBeAsShort) {
  const PathCandidate first = arc(0.2), second = arc(-0.2001);
  const double gap = second.length - first.length;
  EXPECT_TRUE(detail::first_is_unique(filed({first, second}), 1e-12));
  EXPECT_FALSE(detail::first_is_unique(filed({first, arc(-0.2001, 1.1 * gap)}), 1e-12));
  EXPECT_FALSE(detail::first_is_unique(filed({first, second}), 1.1 * gap / first.length));
}

// Lengths known to a few digits: of two starts that lead to one geodesic the shorter for certain is kept.
TEST(Contenders, OneGeodesicIsCorrectedOnce) {
  const auto rough = [](double height, double error) {
    NewtonResult result;
    result.status = Status::ok;
    const PathCandidate curve = arc(height, error);
    result.points = curve.points;
    result.length = curve.length;
    result.length_error = error;
    return detail::contender(curve.points, result);
  };
  std::vector<detail::Contender> contenders;
  detail::add_contender(contenders, rough(0.2, 1e-3));
  detail::add_contender(contenders, rough(0.2, 1e-4));
  detail::add_contender(contenders, rough(-0.2, 1e-4));
  ASSERT_EQ(contenders.size(), 2U);
  EXPECT_LT(contenders[0].at_most() - contenders[0].geodesic.length, 1e-3);
  EXPECT_GT(contenders[0].at_most(), contenders[0].geodesic.length);
  EXPECT_LT(contenders[0].at_least(), contenders[0].geodesic.length);
}

}  // namespace
}  // namespace taut
