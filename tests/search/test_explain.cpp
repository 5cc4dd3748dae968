// The sentences of a result, word for word: nothing else compares them.
#include "search/explain.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace taut {
namespace {

/// Between two points in three dimensions, on cells of 0.25.
PathResult answer() {
  PathResult result;
  result.from = Eigen::Vector3d(1, 0, 0);
  result.to = Eigen::Vector3d(0, 1, 0);
  result.cell = 0.25;
  result.length = 2;
  result.marched = 1.5;
  result.window = {Eigen::Vector3d(-1, -2, -3), Eigen::Vector3d(1, 2, 3)};
  return result;
}

std::string doubted(Doubts doubts) {
  PathResult result = answer();
  result.status = Status::ok;
  result.doubts = doubts;
  return detail::explain(result);
}

std::string stopped(Obstacle obstacle, Doubts doubts = {}) {
  PathResult result = answer();
  result.obstacle = std::move(obstacle);
  result.doubts = doubts;
  return detail::explain(result);
}

TEST(Explain, DoubtsInWords) {
  const std::string may = "a shorter path may exist: ";
  EXPECT_EQ(doubted({}), "");
  EXPECT_EQ(doubted({Doubt::beyond_window}), may + "the surface goes on beyond [-1, 1] x [-2, 2] x [-3, 3]");
  EXPECT_EQ(doubted({Doubt::start_failed}),
            may + "the cells know a way of length 1.5, but no geodesic was found along it");
  EXPECT_EQ(
      doubted({Doubt::sheets_not_told}),
      may + "cells of 0.25 cannot tell the sheets of the surface apart, this one was found by walks from both ends");
  EXPECT_EQ(doubted({Doubt::cells_spent}),
            may + "found by walks, for as many cells of 0.25 as may grow do not lead from one end to the other");
  for (const Doubt doubt : {Doubt::coarse_cells, Doubt::sharp_bends}) {
    EXPECT_EQ(doubted({doubt}), may + "cells of 0.25 are coarser than the surface bends, and miss ways");
  }
  EXPECT_EQ(doubted({Doubt::edges_not_searched}),
            may +
                "over the edges of this surface it was not looked for (they are too many, or another method or march "
                "than the default was asked for)");
  EXPECT_EQ(doubted({Doubt::edges_failed}), may + "over the edges of this surface no way was found");
  EXPECT_EQ(doubted({Doubt::budget_spent}), may + "it was not looked for everywhere");
  EXPECT_EQ(doubted({Doubt::random_search, Doubt::rivals_not_sought}), "");
}

TEST(Explain, OfSeveralDoubtsTheGravestIsSaid) {
  EXPECT_EQ(doubted({Doubt::coarse_cells, Doubt::start_failed}), doubted({Doubt::start_failed}));
  EXPECT_EQ(doubted({Doubt::start_failed, Doubt::beyond_window}), doubted({Doubt::beyond_window}));
  EXPECT_EQ(doubted({Doubt::rivals_not_sought, Doubt::coarse_cells}), doubted({Doubt::coarse_cells}));
}

TEST(Explain, ObstaclesInWords) {
  using Kind = Obstacle::Kind;
  const Vector place = Eigen::Vector3d(0, 0.5, 1);
  EXPECT_EQ(stopped({Kind::apart}), "the two points lie on different components of the surface");
  EXPECT_EQ(
      stopped({Kind::apart}, {Doubt::beyond_window}),
      "the two points lie on different components of the surface within [-1, 1] x [-2, 2] x [-3, 3], beyond which "
      "it goes on");
  EXPECT_EQ(stopped({Kind::apart_by_fan}),
            "the two points lie on different components of the surface: no geodesic from the start, of those in all "
            "directions, comes to the end");
  EXPECT_EQ(stopped({Kind::singular_end, place}),
            "the surface is singular at (0, 0.5, 1): a gradient vanishes there, or the equations depend on each other; "
            "take a point beside it");
  EXPECT_EQ(stopped({Kind::apart_by_walks}),
            "no path was found: the two points seem to lie on different components (random searches from both ends do "
            "not meet; in 3 dimensions there are no cells to prove it; samples of the surface may help)");
  EXPECT_EQ(stopped({Kind::narrow_gap, place, 0.001}),
            "no path was found on cells down to 0.25: near (0, 0.5, 1) parts of the surface come within 0.001 of each "
            "other, be it sheets that nearly touch or the two sides of a thin neck");
  EXPECT_EQ(stopped({Kind::singular_between, place}),
            "the surface is singular between the two points: near (0, 0.5, 1) its gradient falls to nothing; geodesics "
            "through a singular point are not supported");
  EXPECT_EQ(stopped({Kind::sheets_not_told}),
            "no path was found: cells down to 0.25 cannot tell the sheets of the surface apart, or the points lie on "
            "different components");
  EXPECT_EQ(stopped({Kind::coarse_cells}),
            "no path was found, neither on cells of 0.25, coarser than the surface bends, nor by walks from both ends; "
            "give a smaller box around both points, or smaller cells");
  EXPECT_EQ(
      stopped({Kind::corner, place}),
      "the surface is not smooth at (0, 0.5, 1): its normal jumps there; take a point beside the crease or corner");
  EXPECT_EQ(
      stopped({Kind::crease, place, std::numbers::pi / 2}),
      "the surface is not smooth between the two points: near (0, 0.5, 1) its normal turns by 90 degrees within a "
      "cell of 0.25; geodesics over a crease or through a singular point are not supported");
  EXPECT_EQ(
      stopped({Kind::no_way}),
      "no path was found on cells down to 0.25; that there is none is not proved: a smaller box around both points "
      "may help");
  EXPECT_EQ(stopped({Kind::cells_spent}),
            "no path was found: as many cells of 0.25 as may grow do not lead from one end to the other");
  EXPECT_EQ(stopped({Kind::jumped, {}, 1.5}), "the corrected path is longer (2) than the one on the cells (1.5)");
  EXPECT_EQ(stopped({Kind::loose_ends}), "the curve found does not lead from one end to the other; please report this");
  EXPECT_EQ(stopped({Kind::faces}), "the path over the edges of this surface was not found");
  EXPECT_EQ(stopped({Kind::contracts}),
            "the loop contracts to where the surface is singular, or thinner than cells can tell");
}

TEST(Explain, ACurveThatIsNoGeodesicHasItsReasonAndPlace) {
  PathResult result = answer();
  result.reason = "the curve stops";
  result.obstacle = {Obstacle::Kind::no_geodesic, Eigen::Vector3d(1, 2, 3)};
  EXPECT_EQ(detail::explain(result), "the curve stops, near (1, 2, 3)");
  result.obstacle.place = Vector::Zero(17);  // too long to be printed
  EXPECT_EQ(detail::explain(result), "the curve stops");
}

TEST(Explain, EveryDoubtHasAName) {
  Doubts all;
  for (int i = 0; i < kNumDoubts; ++i) all.add(static_cast<Doubt>(i));
  int count = 0;
  all.for_each([&](Doubt doubt) {
    EXPECT_NE(to_string(doubt), "unknown");
    ++count;
  });
  EXPECT_EQ(count, kNumDoubts);
  EXPECT_EQ(to_string(static_cast<Doubt>(kNumDoubts)), "unknown");
  all.remove(Doubt::coarse_cells);
  EXPECT_FALSE(all.has(Doubt::coarse_cells));
  EXPECT_TRUE(all.has(Doubt::start_failed));
}

}  // namespace
}  // namespace taut
