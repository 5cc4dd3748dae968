// Polylines and loops pulled taut over edges, and the second variation of broken geodesics, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "strata/faceted_surface.hpp"
#include "strata/polyline_way.hpp"
#include "strata/shorten_chain.hpp"
#include "strata/way_chain.hpp"
#include "taut/core/error.hpp"
#include "taut/query/closed_geodesic.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;
const std::string kCan = "max(x^2+y^2-4, abs(z)-1)";
const std::string kBox = "max(abs(x)-15,abs(y)-6,abs(z)-6)";

Points through(const std::vector<Eigen::Vector3d>& points) {
  Points all(3, static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) all.col(static_cast<Index>(i)) = points[i];
  return all;
}

ClosedGeodesic loop(const std::string& formula, const std::vector<Eigen::Vector3d>& points) {
  return closed_geodesic(parse_surface(formula), through(points));
}

PathResult pulled(const std::string& formula, const std::vector<Eigen::Vector3d>& points) {
  return path_in_class(parse_surface(formula), through(points));
}

void expect_length(const PathResult& found, double length) {
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_NEAR(found.length, length, 1e-11 * length);
  EXPECT_LE(std::abs(found.length - length), found.length_error + 1e-12 * length);
}

// Any loop round the belly slides along the box: its length does not change.
TEST(FacetLoops, RoundABox) {
  const ClosedGeodesic found = loop(kBox, {{1, 6, 2}, {2, 3, 6}, {0, -6, 1}, {-1, 2, -6}});
  expect_length(found, 48);
  EXPECT_EQ(found.index, 0);
  EXPECT_EQ(found.neutral, 1);
  EXPECT_EQ(found.points.col(0), found.points.rightCols(1));
  EXPECT_EQ(found.pieces.size(), 8U);
}

// Over both lids, from rim to rim. With crossings turned by a, b on the upper rim and c, d on the lower one the length
// changes by -R/4 ((a - b)^2 + (c - d)^2) + R^2/(2 H) ((a - c)^2 + (b - d)^2): all four alike is a rotation, all chords
// moved aside together make it shorter, and in a can higher than wide so does moving them to different sides.
TEST(FacetLoops, OverBothLidsOfACan) {
  const ClosedGeodesic low = loop(kCan, {{2, 0, 0}, {0, 0, 1}, {-2, 0, 0}, {0, 0, -1}});
  expect_length(low, 12);
  EXPECT_EQ(low.index, 1);
  EXPECT_EQ(low.neutral, 1);
  const ClosedGeodesic high =
      loop("max(x^2+y^2-4, abs(z)-3)", {{2, 0, 0}, {1, 0, 3}, {-1, 0, 3}, {-2, 0, 0}, {-1, 0, -3}, {1, 0, -3}});
  expect_length(high, 20);
  EXPECT_EQ(high.index, 2);
  EXPECT_EQ(high.neutral, 1);
  EXPECT_FALSE(high.locally_shortest);
}

TEST(FacetLoops, RoundTheSideOfACan) {
  const ClosedGeodesic found = loop(kCan, {{2, 0, 0.1}, {0, 2, 0.3}, {-2, 0, -0.2}, {0, -2, 0}});
  expect_length(found, 4 * kPi);
}

// Over the flat face and the cap: chord and arc.
TEST(FacetLoops, RoundALens) {
  const ClosedGeodesic found = loop("max(x^2+y^2+z^2-1, 0.5-z)", {{0.5, 0, 0.5},
                                                                  {std::sqrt(0.5), 0, std::sqrt(0.5)},
                                                                  {0, 0, 1},
                                                                  {-std::sqrt(0.5), 0, std::sqrt(0.5)},
                                                                  {-0.5, 0, 0.5}});
  expect_length(found, std::sqrt(3.0) + 2 * kPi / 3);
  EXPECT_EQ(found.index, 1);
  EXPECT_EQ(found.neutral, 1);
}

// Over the lid and round the side are both taut: which is meant the polyline says.
TEST(FacetLoops, APolylineKeepsItsWay) {
  const PathResult over = pulled(kCan, {{2, 0, 0.5}, {1.5, 0.3, 1}, {0, 0.2, 1}, {-1.5, 0.1, 1}, {-2, 0, 0.5}});
  expect_length(over, 5);
  EXPECT_TRUE(over.locally_shortest);
  EXPECT_FALSE(over.unique);
  const PathResult round =
      pulled(kCan, {{2, 0, 0.5}, {std::sqrt(2.0), std::sqrt(2.0), 0.2}, {0, 2, 0.1}, {-2, 0, 0.5}});
  expect_length(round, 2 * kPi);
}

TEST(FacetLoops, APolylineRoundABoxStaysWound) {
  const PathResult once = pulled(kBox, {{0, 6, 0}, {0, 0, 6}, {0, -6, 0}, {0, 0, -6}, {1, 6, 0}});
  expect_length(once, std::hypot(48, 1));
  EXPECT_EQ(once.pieces.size(), 9U);
}

TEST(FacetLoops, OffTheFacesIsRefused) {
  EXPECT_THROW((void)pulled(kCan, {{20, 0, 0.5}, {-20, 0, 0.5}}), InvalidArgument);
  EXPECT_THROW((void)loop(kCan, {{20, 0, 0.5}, {-20, 0, 0.5}, {0, 20, 1}}), InvalidArgument);
}

/// The geodesic next to a polyline, be it a minimum or not.
detail::FacetChain next_to(const std::string& formula, const std::vector<Eigen::Vector3d>& points) {
  const std::unique_ptr<detail::FacetedSurface> surface = detail::FacetedSurface::of(parse_surface(formula));
  surface->scale = 10;
  detail::FacetChain chain = detail::chain_of(*surface, detail::way_along_polyline(*surface, through(points)).value());
  chain.stationary = true;
  std::vector<detail::FacetChain> others;
  detail::shorten_chain(*surface, chain, others, {});
  return chain;
}

// From h below the rim over the lid to g below it on the other side. Rays from the start that cross both rims meet
// again 2 R - h below the second one: farther on the way is no minimum any more.
TEST(FacetLoops, OverALidBeyondTheConjugatePoint) {
  const auto over = [](double h, double g) {
    return next_to("max(x^2+y^2-4, abs(z)-5)",
                   {{2, 0, 5 - h}, {1.9, 0.1, 5}, {0, 0.1, 5}, {-1.9, 0, 5}, {-2, 0, 5 - g}});
  };
  const detail::FacetChain near = over(1.5, 2.4);
  ASSERT_TRUE(near.solved);
  EXPECT_NEAR(near.length, 7.9, 1e-11);
  EXPECT_EQ(near.index, 0);
  EXPECT_TRUE(near.locally_shortest);
  const detail::FacetChain far = over(1.5, 2.6);
  ASSERT_TRUE(far.solved);
  EXPECT_NEAR(far.length, 8.1, 1e-11);
  EXPECT_EQ(far.index, 1);
  EXPECT_FALSE(far.locally_shortest);
}

// On planes nothing turns back: every geodesic over straight edges is a minimum.
TEST(FacetLoops, OverARoof) {
  const detail::FacetChain roof = next_to("z+abs(x)", {{-1, 0, -1}, {0, 0.4, 0}, {1, 1, -1}});
  ASSERT_TRUE(roof.solved);
  EXPECT_NEAR(roof.length, 3, 1e-12);
  EXPECT_TRUE(roof.locally_shortest);
  EXPECT_EQ(roof.index, 0);
}

}  // namespace
}  // namespace taut
