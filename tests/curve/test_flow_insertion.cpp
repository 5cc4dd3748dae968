#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "curve/gap_insertion.hpp"
#include "support/surfaces.hpp"
#include "taut/curve/flow.hpp"

// Insertion at eps_E and equation (5), sec. 4 of the paper, on a surface with gaps like those of its Figures 3 and 4.

namespace taut {
namespace {

/// z = -exp(-(x / w)^2): a groove along y, 1 deep and some 2 w wide; unrolled it is a plane.
struct GrooveFunction {
  double w = 0.1;
  [[nodiscard]] static Index dim() { return 3; }
  [[nodiscard]] double depth(double x) const { return std::exp(-(x / w) * (x / w)); }
  [[nodiscard]] double slope(double x) const { return 2 * x / (w * w) * depth(x); }
  [[nodiscard]] double value(const Vector& x) const { return x(2) + depth(x(0)); }
  [[nodiscard]] Vector gradient(const Vector& x) const { return Eigen::Vector3d(-slope(x(0)), 0, 1); }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    const double u = x(0) / w;
    return Eigen::Vector3d((4 * u * u - 2) / (w * w) * depth(x(0)), 0, 0).asDiagonal();
  }
  [[nodiscard]] Eigen::Vector3d point(double x, double y = 0) const { return {x, y, -depth(x)}; }
};

constexpr GrooveFunction kGroove{0.1};

/// From wall to wall through the air, its middle a little nearer to the left one.
Points over_the_groove() {
  Points gap(3, 2);
  gap << kGroove.point(-0.15), kGroove.point(0.147);
  return gap;
}

const FlowLattice kOneCell{.size = 3, .origin = Eigen::Vector3d(-1.5, -1.5, -2)};

// Both ends of the gap in one cell, and the ordinary projection falls back: Figure 4.
TEST(GapInsertion, TheProjectionFallsBackAndThePlaneLeadsIn) {
  const Surface surface = test::make_surface(kGroove);
  Points points = over_the_groove();
  detail::CountingEvaluator evaluator(surface);
  detail::GapInsertion insertion(evaluator, 3, 1, kOneCell);
  ASSERT_EQ(insertion.insert(points, {true}), 1);
  EXPECT_EQ(insertion.num_projected(), 0);
  EXPECT_EQ(insertion.num_in_plane(), 1);
  EXPECT_EQ(insertion.num_across_cells(), 0);
  // In the plane through the middle of the chord: x is that of the middle nearly, down in the groove.
  EXPECT_NEAR(points(0, 1), -0.0015, 0.05);
  EXPECT_LT(points(2, 1), -0.8);
  EXPECT_NEAR(kGroove.value(points.col(1)), 0, 1e-8);
}

TEST(GapInsertion, WhereProjectionClosesTheGapThereIsNoPlane) {
  const Surface sphere = test::unit_sphere();
  Points points(3, 5);
  for (Index i = 0; i < 5; ++i) {
    const double t = 0.3 * static_cast<double>(i);
    points.col(i) << std::cos(t), std::sin(t), 0;
  }
  detail::CountingEvaluator evaluator(sphere);
  detail::GapInsertion insertion(evaluator, 3, 1, {.size = 4, .origin = Eigen::Vector3d(-2, -2, -2)});
  EXPECT_EQ(insertion.insert(points, {true, false, true, true}), 3);
  EXPECT_EQ(insertion.num_projected(), 3);
  EXPECT_EQ(insertion.num_in_plane(), 0);
  ASSERT_EQ(points.cols(), 8);
  EXPECT_NEAR((points.col(1) - Eigen::Vector3d(std::cos(0.15), std::sin(0.15), 0)).norm(), 0, 1e-9);
}

TEST(GapInsertion, AGapWiderThanACellIsCountedApart) {
  const Surface surface = test::make_surface(kGroove);
  detail::CountingEvaluator evaluator(surface);
  // The same size of cells, the gap within one of them or over a face between two: the origin decides.
  for (const double origin : {-0.5, 0.0}) {
    Points points = over_the_groove();
    detail::GapInsertion insertion(evaluator, 3, 1, {.size = 1.2, .origin = Eigen::Vector3d(origin, -0.5, -1.1)});
    (void)insertion.insert(points, {true});
    EXPECT_EQ(insertion.num_projected(), 0);
    EXPECT_EQ(insertion.num_across_cells(), origin == 0.0 ? insertion.num_in_plane() : 0) << "origin " << origin;
    if (origin != 0.0) {
      EXPECT_EQ(insertion.num_in_plane(), 1);
    }
  }
}

/// (x^2 / a^2 + z^2 / b^2 - 1) exp(k x) = 0 for all y: two walls that come together above and below; unrolled it is a
/// plane. Between the walls the gradient points to the left one.
struct FlatTubeFunction {
  double a = 0.4;
  double b = 1.2;
  double k = 4;
  [[nodiscard]] static Index dim() { return 3; }
  [[nodiscard]] double quadric(const Vector& x) const { return x(0) * x(0) / (a * a) + x(2) * x(2) / (b * b) - 1; }
  [[nodiscard]] Eigen::Vector3d slope(const Vector& x) const { return {2 * x(0) / (a * a), 0, 2 * x(2) / (b * b)}; }
  [[nodiscard]] double value(const Vector& x) const { return std::exp(k * x(0)) * quadric(x); }
  [[nodiscard]] Vector gradient(const Vector& x) const {
    return std::exp(k * x(0)) * (slope(x) + k * quadric(x) * Eigen::Vector3d::UnitX());
  }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    Eigen::Matrix3d bend = Eigen::Vector3d(2 / (a * a), 0, 2 / (b * b)).asDiagonal();
    bend.row(0) += k * slope(x).transpose();
    bend.col(0) += k * slope(x);
    bend(0, 0) += k * k * quadric(x);
    return std::exp(k * x(0)) * bend;
  }
  /// By the angle from the right wall's middle to the top.
  [[nodiscard]] Eigen::Vector3d point(double t, double y = 0) const { return {a * std::cos(t), y, b * std::sin(t)}; }
  /// Of the arc between two angles, by Simpson's rule.
  [[nodiscard]] double length(double from, double to) const {
    constexpr int kParts = 2000;
    const double step = (to - from) / kParts;
    double sum = 0;
    for (int i = 0; i <= kParts; ++i) {
      const double t = from + i * step;
      sum += (i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2) * std::hypot(a * std::sin(t), b * std::cos(t));
    }
    return sum * step / 3;
  }
};

// A start that crosses from wall to wall in one cell, as a marched path may. Projected, every new node falls back on
// the left wall, and the curve would rest in another class, or nowhere; (5) leads it over the top.
TEST(FlowInsertion, FromWallToWallInOneCellThePlaneLeadsOverTheTop) {
  constexpr FlatTubeFunction kTube;
  const Surface surface = test::make_surface(kTube);
  constexpr double kFrom = -0.9;
  constexpr Index kSide = 20;
  const double truth = kTube.length(kFrom, std::numbers::pi - kFrom);
  for (const double last : {0.1, 0.25}) {
    Points start(3, 2 * kSide);
    for (Index i = 0; i < kSide; ++i) {
      const double part = static_cast<double>(i) / (kSide - 1);
      const double t = kFrom + part * (last - kFrom);
      const double y = 0.03 * std::sin(std::numbers::pi * part);
      start.col(i) = kTube.point(std::numbers::pi - t, y);
      start.col(2 * kSide - 1 - i) = kTube.point(t + 0.01 * part, -y);
    }
    for (const double spacing : {0.0, 0.03}) {
      const FlowResult result = correct_flow(surface, start, {.spacing = spacing, .lattice = kOneCell});
      ASSERT_EQ(result.status, Status::ok) << result.reason;
      EXPECT_GE(result.summary.num_plane_inserted, 1);
      EXPECT_LE(result.length, truth);
      EXPECT_NEAR(result.length, truth, result.length_error) << "last " << last << ", spacing " << spacing;
      EXPECT_LT(result.length_error, 1e-3);
    }
  }
}

// Round the edge of a flat ellipsoid nodes rest unevenly: some intervals stay longer than the mean.
TEST(FlowInsertion, NoIntervalIsLongerThanTheSpacingOnAFlatEllipsoid) {
  const Surface surface = test::ellipsoid(1, 1, 0.1);
  Points start(3, 41);
  for (Index i = 0; i <= 40; ++i) {
    const double t = static_cast<double>(i) / 40;
    const Eigen::Vector3d x = (1 - t) * Eigen::Vector3d(1, 0, 0) + t * Eigen::Vector3d(-0.9, 0.3, 0.0316);
    start.col(i) = Eigen::Vector3d(x(0), x(1), 0.1 * std::sqrt(std::max(0.0, 1 - x(0) * x(0) - x(1) * x(1))));
  }
  const Vector end = start.col(40);
  start.col(40) = end / std::sqrt(1 + test::EllipsoidFunction{Eigen::Vector3d(1, 1, 0.1)}.value(end));
  double coarser = 0;
  for (const double spacing : {0.05, 0.02, 0.01}) {
    const FlowResult result = correct_flow(surface, start, {.spacing = spacing});
    ASSERT_EQ(result.status, Status::ok) << result.reason << " at " << spacing;
    EXPECT_LE(result.summary.longest_interval, spacing * (1 + 1e-6));
    EXPECT_GT(result.summary.longest_interval, 0.4 * spacing);
    if (coarser > 0) {
      EXPECT_NEAR(result.length, coarser, 2e-3);
    }
    coarser = result.length;
  }
}

// Nodes slide out of a sharp bend, where a long chord is shorter than two: the flow must cut its surroundings, too. The
// groove unrolls to a plane; its length is that of the graph from -1 to 1.
TEST(FlowInsertion, ANarrowGrooveIsFollowedToItsBottom) {
  constexpr int kParts = 20000;  // Simpson's rule
  double truth = 0;
  for (int i = 0; i <= kParts; ++i) {
    const double x = -1 + 2.0 * i / kParts;
    const double weight = i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2;
    truth += weight * std::sqrt(1 + kGroove.slope(x) * kGroove.slope(x)) * 2 / (3.0 * kParts);
  }
  EXPECT_NEAR(truth, 3.634092, 1e-6);
  // As the march leaves it: a point a cell, walls to and fro.
  std::vector<Vector> walked;
  for (double x = -1; x < 1; x += 0.02 / std::hypot(1, kGroove.slope(x))) {
    walked.emplace_back(kGroove.point(x, 0.01 * std::sin(25 * x) * (1 - x * x)));
  }
  walked.front() = kGroove.point(-1);
  walked.emplace_back(kGroove.point(1));
  Points start(3, static_cast<Index>(walked.size()));
  for (Index i = 0; i < start.cols(); ++i) start.col(i) = walked[static_cast<std::size_t>(i)];
  const Surface surface = test::make_surface(kGroove);
  for (const double spacing : {0.1, 0.05, 0.03}) {
    const FlowOptions options{.spacing = spacing, .lattice = {.size = 0.025, .origin = Eigen::Vector3d(-2, -2, -2)}};
    const FlowResult result = correct_flow(surface, start, options);
    ASSERT_EQ(result.status, Status::ok) << spacing << ": " << result.reason;
    EXPECT_LE(result.summary.longest_interval, spacing * (1 + 1e-6));
    EXPECT_NEAR(result.length, truth, result.length_error) << spacing;
    EXPECT_LT(result.length_error, 2e-3) << spacing;
  }
}

TEST(FlowInsertion, LatticeMustHaveAnOrigin) {
  const Surface sphere = test::unit_sphere();
  Points start(3, 3);
  start << Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.8, 0.6, 0), Eigen::Vector3d(0, 1, 0);
  EXPECT_THROW((void)correct_flow(sphere, start, {.lattice = {.size = 0.1, .origin = {}}}), std::exception);
}

}  // namespace
}  // namespace taut
