#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <random>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/flow.hpp"

namespace taut {
namespace {

using test::ellipsoid;
using test::torus;
using test::unit_sphere;

constexpr double kPi = std::numbers::pi;

/// The chord from p to q in `num_intervals` pieces, its inner nodes moved at random by `noise` chords.
Points noisy_chord(const Vector& p, const Vector& q, Index num_intervals, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Points start(p.size(), num_intervals + 1);
  for (Index i = 0; i <= num_intervals; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(num_intervals);
    start.col(i) = (1 - t) * p + t * q;
    if (i == 0 || i == num_intervals) continue;
    for (Index c = 0; c < p.size(); ++c) start(c, i) += noise * (q - p).norm() * normal(random);
  }
  start.col(0) = p;
  start.col(num_intervals) = q;
  return start;
}

/// Slope of log error against log spacing between the first and the last spacing.
double measured_order(const Surface& surface, const Points& start, double truth, double coarsest, int num_halvings) {
  double first = 0;
  double last = 0;
  for (int i = 0; i <= num_halvings; ++i) {
    FlowOptions options;
    options.spacing = coarsest / std::pow(2.0, i);
    const FlowResult result = correct_flow(surface, start, options);
    EXPECT_EQ(result.status, Status::ok) << result.reason;
    const double error = truth - result.length;
    EXPECT_GT(error, 0) << "a polyline of chords is shorter than its geodesic";
    EXPECT_LE(error, result.length_error);
    EXPECT_NEAR(result.summary.error_sum, error, 0.05 * error) << "(A1) at spacing " << options.spacing;
    if (i == 0) first = error;
    last = error;
  }
  return std::log2(first / last) / num_halvings;
}

TEST(Flow, QuarterOfTheUnitCircleWithinDefaultAccuracy) {
  const FlowResult result =
      correct_flow(unit_sphere(), noisy_chord(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), 20, 0.05, 1));
  EXPECT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_NEAR(result.length, kPi / 2, 1e-4);
  EXPECT_LE(std::abs(result.length - kPi / 2), result.length_error);
  EXPECT_LE(result.residual.geodesic_curvature, 1e-6 / result.length);
  EXPECT_TRUE(result.locally_shortest);
  // The great circle is z = 0; the ends are exactly the ends asked for.
  EXPECT_LT(result.points.row(2).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_EQ(result.points.col(0), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(result.points.rightCols(1), Eigen::Vector3d(0, 1, 0));
}

TEST(Flow, SphereOfAnyDimension) {
  for (const Index d : {2, 4, 6, 50}) {
    const Vector p = Vector::Unit(d, 0);
    const Vector q = Vector::Unit(d, d - 1);
    const FlowResult result = correct_flow(unit_sphere(d), noisy_chord(p, q, 16, 0.01, 2));
    EXPECT_EQ(result.status, Status::ok) << "d = " << d << ": " << result.reason;
    EXPECT_NEAR(result.length, kPi / 2, 1e-4) << "d = " << d;
  }
}

TEST(Flow, SecondOrderOnTheSphere) {
  const Points start = noisy_chord(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0.6, 0.8), 25, 0.03, 3);
  EXPECT_NEAR(measured_order(unit_sphere(), start, kPi / 2, kPi / 32, 5), 2, 0.05);
}

TEST(Flow, SecondOrderOnTheEllipsoid) {
  // Triaxial, semi-axes 3, 2, 1: two pairs whose distance is known to 16 digits.
  const Eigen::Vector3d p(-0.23363115159111386, -0.7315116077583782, -0.927446956396633);
  const Eigen::Vector3d q(-2.4367779786294284, -0.44078704610541597, -0.5400569247603457);
  EXPECT_NEAR(measured_order(ellipsoid(3, 2, 1), noisy_chord(p, q, 25, 0.02, 4), 2.2707647729760136, 0.1, 5), 2, 0.1);
}

TEST(Flow, SecondOrderOnTheTorus) {
  const Eigen::Vector3d p(-0.5433668656435354, -1.1678564928931952, -0.2775121407559183);
  const Eigen::Vector3d q(0.040909897463848426, -1.397918888258106, 0.0344079171584778);
  EXPECT_NEAR(measured_order(torus(1, 0.4), noisy_chord(p, q, 25, 0.02, 5), 0.7193800165323128, 0.04, 5), 2, 0.1);
}

TEST(Flow, StartsOfDifferentResolutionEndAsTheSameCurve) {
  struct Case {
    Surface surface;
    Eigen::Vector3d p, q;
  };
  const Case cases[] = {
      {unit_sphere(), {1, 0, 0}, {0, 0.6, 0.8}},
      {ellipsoid(3, 2, 1),
       {2.3956522815795176, 0.8918617196357883, -0.40430477504552514},
       {1.733285728870478, 1.5660039883381829, 0.2304323174284397}},
      {torus(1, 0.4),
       {-0.5433668656435354, -1.1678564928931952, -0.2775121407559183},
       {0.040909897463848426, -1.397918888258106, 0.0344079171584778}},
  };
  for (const Case& c : cases) {
    for (const double spacing : {0.0, 0.013}) {
      FlowOptions options;
      options.spacing = spacing;
      const FlowResult coarse = correct_flow(c.surface, noisy_chord(c.p, c.q, 9, 0.04, 6), options);
      const FlowResult fine = correct_flow(c.surface, noisy_chord(c.p, c.q, 40, 0.015, 7), options);
      EXPECT_EQ(coarse.status, Status::ok) << coarse.reason;
      EXPECT_EQ(fine.status, Status::ok) << fine.reason;
      EXPECT_EQ(coarse.points.cols(), fine.points.cols());
      EXPECT_NEAR(coarse.length, fine.length, 1e-9 * coarse.length);
      EXPECT_LT((coarse.points - fine.points).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST(Flow, ExplicitStepsComeToRestOnTheSameCurve) {
  const Points start = noisy_chord(Eigen::Vector3d(1.4, 0, 0), Eigen::Vector3d(0, 0.8, 0.346410161513775), 16, 0.02, 8);
  FlowOptions options;
  options.spacing = 0.1;
  const FlowResult implicit = correct_flow(torus(1, 0.4), start, options);
  options.time_step = FlowTimeStep::explicit_euler;
  const FlowResult explicit_result = correct_flow(torus(1, 0.4), start, options);
  ASSERT_EQ(implicit.status, Status::ok) << implicit.reason;
  ASSERT_EQ(explicit_result.status, Status::ok) << explicit_result.reason;
  EXPECT_GT(explicit_result.num_iterations, 10 * implicit.num_iterations);
  EXPECT_NEAR(explicit_result.length, implicit.length, 1e-9);
  EXPECT_LT((explicit_result.points - implicit.points).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Flow, NodesAreEvenAndNoIntervalExceedsTheSpacing) {
  FlowOptions options;
  options.spacing = 0.031;
  const FlowResult result = correct_flow(
      ellipsoid(3, 2, 1), noisy_chord(Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0, 2, 0), 12, 0.02, 10), options);
  ASSERT_EQ(result.status, Status::ok) << result.reason;
  const Index m = result.points.cols() - 1;
  const auto intervals = (result.points.rightCols(m) - result.points.leftCols(m)).colwise().norm().eval();
  EXPECT_LE(intervals.maxCoeff(), options.spacing);
  EXPECT_LT(intervals.maxCoeff() / intervals.minCoeff(), 1.01);
  EXPECT_GT(result.summary.num_inserted, 0);
  EXPECT_NEAR(intervals.sum(), result.length, 1e-12);
}

TEST(Flow, ConjugatePointInsideIsFound) {
  // The long way round a great circle: the antipode of the start at length pi is conjugate to it.
  Points start(3, 25);
  for (Index i = 0; i < 25; ++i) {
    const double angle = 1.5 * kPi * static_cast<double>(i) / 24;
    start.col(i) << std::cos(angle), std::sin(angle), 0;
  }
  const FlowResult result = correct_flow(unit_sphere(), start);
  ASSERT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_NEAR(result.length, 1.5 * kPi, 1e-4 * 1.5 * kPi);
  EXPECT_FALSE(result.locally_shortest);
  ASSERT_TRUE(result.conjugate_at.has_value());
  EXPECT_NEAR(*result.conjugate_at, kPi, 2 * result.summary.longest_interval);
}

TEST(Flow, ScaleAndUnitsOfFDoNotMatter) {
  // A sphere of radius 1e6: F grows by 1e12, lengths by 1e6.
  const double R = 1e6;
  const Points start = noisy_chord(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), 20, 0.05, 12);
  const FlowResult unit = correct_flow(unit_sphere(), start);
  const FlowResult large = correct_flow(ellipsoid(R, R, R), R * start);
  ASSERT_EQ(large.status, Status::ok) << large.reason;
  EXPECT_EQ(large.points.cols(), unit.points.cols());
  EXPECT_NEAR(large.length / R, unit.length, 1e-10);
}

TEST(Flow, CloseEnds) {
  const double angle = 1e-7;
  const Eigen::Vector3d q(std::cos(angle), std::sin(angle), 0);
  const FlowResult result = correct_flow(unit_sphere(), noisy_chord(Eigen::Vector3d(1, 0, 0), q, 4, 0.1, 13));
  EXPECT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_NEAR(result.length, angle, 1e-4 * angle);
}

// Ends 1e-13 apart kept the flow stirring rounding for minutes (2026-11), and from 1e-10 on an end "did not lie on the
// surface" by its own rounding.
TEST(Flow, EndsCloserThanItsNodesCouldBeAreJoinedByTheirChord) {
  const Surface surface = ellipsoid(2, 1, 0.5);
  for (double apart = 1e-2; apart > 1e-17; apart /= 10) {
    Points ends(3, 2);
    ends.col(0) = Eigen::Vector3d(2 * std::cos(0.3), std::sin(0.3), 0);
    ends.col(1) = Eigen::Vector3d(2 * std::cos(0.3 + apart), std::sin(0.3 + apart), 0);
    const double chord = (ends.col(1) - ends.col(0)).norm();
    const FlowResult result = correct_flow(surface, ends, {.max_evaluated = 4000});
    EXPECT_EQ(result.status, Status::ok) << result.reason << " at " << apart;
    EXPECT_TRUE(result.locally_shortest) << apart;
    EXPECT_GE(result.length, chord * (1 - 1e-12));
    EXPECT_NEAR(result.length, chord, 4 * apart * apart * chord + 1e-15) << apart;
    EXPECT_EQ(result.points.col(0), ends.col(0));
    EXPECT_EQ(result.points.rightCols<1>(), ends.col(1));
  }
}

// Round the equator and back to within rounding of where it began.
TEST(Flow, ALoopBackToItsStartGivesThatPoint) {
  Points loop(3, 65);
  for (Index i = 0; i <= 64; ++i) {
    const double angle = 2 * kPi * static_cast<double>(i) / 64;
    loop.col(i) = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  }
  const FlowResult result = correct_flow(unit_sphere(), loop);
  EXPECT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_LE(result.length, 1e-15);
}

TEST(Flow, IdenticalEndsGiveThatPoint) {
  const Eigen::Vector3d p(0, 0, 1);
  const FlowResult result = correct_flow(unit_sphere(), noisy_chord(p, p, 4, 0.0, 14));
  EXPECT_EQ(result.status, Status::ok);
  EXPECT_EQ(result.length, 0);
  ASSERT_EQ(result.points.cols(), 2);
  EXPECT_EQ(result.points.col(0), p);
  EXPECT_EQ(result.points.col(1), p);
}

/// z^2 - x^2 - y^2: its gradient vanishes at the apex.
struct ConeFunction {
  [[nodiscard]] static Index dim() { return 3; }
  [[nodiscard]] static double value(const Vector& x) { return x(2) * x(2) - x(0) * x(0) - x(1) * x(1); }
  [[nodiscard]] static Vector gradient(const Vector& x) { return Eigen::Vector3d(-2 * x(0), -2 * x(1), 2 * x(2)); }
  [[nodiscard]] static Eigen::MatrixXd hessian(const Vector&) { return Eigen::Vector3d(-2, -2, 2).asDiagonal(); }
};

TEST(Flow, ApexOfAConeIsRankDeficient) {
  const Surface cone = test::make_surface(ConeFunction{});
  for (const Index num_intervals : {2, 9, 10, 33}) {  // with and without a node on the apex
    const FlowResult result =
        correct_flow(cone, noisy_chord(Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(-1, 0, -1), num_intervals, 0, 15));
    EXPECT_EQ(result.status, Status::rank_deficient) << num_intervals << ": " << result.reason;
    EXPECT_TRUE(result.points.allFinite());
  }
}

TEST(Flow, GeodesicRoundTheConeMatchesTheUnrolledCone) {
  // Half-angle 45 degrees: unrolled, a turn of pi/2 round the axis is a turn of pi/2 sin(45 deg), at distance sqrt 2.
  const double turn = kPi / 2 * std::numbers::sqrt2 / 2;
  const double truth = 2 * std::numbers::sqrt2 * std::sin(turn / 2);
  const FlowResult result = correct_flow(test::make_surface(ConeFunction{}),
                                         noisy_chord(Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(0, 1, 1), 20, 0.03, 16));
  EXPECT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_NEAR(result.length, truth, 1e-4 * truth);
}

/// z, to cut a surface at the plane z = 0.
struct HeightFunction {
  [[nodiscard]] static Index dim() { return 3; }
  [[nodiscard]] static double value(const Vector& x) { return x(2); }
  [[nodiscard]] static Vector gradient(const Vector&) { return Eigen::Vector3d(0, 0, 1); }
  [[nodiscard]] static Eigen::MatrixXd hessian(const Vector&) { return Eigen::Matrix3d::Zero(); }
};

TEST(Flow, LeavingTheDomainIsSaid) {
  SurfaceExtras extras;
  extras.domain = std::make_shared<test::ScalarFunction<HeightFunction>>(HeightFunction{});
  // z >= 0 cuts the ellipsoid x^2/4 + y^2 + z^2 shifted nowhere: between points of the rim the geodesic stays in it ...
  const Surface half = test::make_surface(test::EllipsoidFunction{Vector::Ones(3)}, extras);
  const double s = std::sqrt(0.5);
  const FlowResult inside =
      correct_flow(half, noisy_chord(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, s, s), 10, 0, 17));
  EXPECT_EQ(inside.status, Status::ok) << inside.reason;
  // ... and a path that starts below the rim does not.
  const FlowResult outside =
      correct_flow(half, noisy_chord(Eigen::Vector3d(0, s, -s), Eigen::Vector3d(1, 0, 0), 10, 0, 18));
  EXPECT_EQ(outside.status, Status::left_domain);
}

TEST(Flow, RefusesWhatItCannotMean) {
  const Surface sphere = unit_sphere();
  Points start = noisy_chord(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), 4, 0, 19);
  EXPECT_THROW((void)correct_flow(sphere, start.leftCols(1)), InvalidArgument);
  EXPECT_THROW((void)correct_flow(sphere, start.topRows(2)), InvalidArgument);
  FlowOptions options;
  options.spacing = -1;
  EXPECT_THROW((void)correct_flow(sphere, start, options), InvalidArgument);
  options.spacing = 1e-9;
  EXPECT_THROW((void)correct_flow(sphere, start, options), OutOfMemory);
  options = {};
  options.beta = 0;
  EXPECT_THROW((void)correct_flow(sphere, start, options), InvalidArgument);
  start(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)correct_flow(sphere, start), InvalidArgument);
}

TEST(Flow, StopsWhenCancelled) {
  const std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  EXPECT_THROW(
      (void)correct_flow(unit_sphere(), noisy_chord(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), 4, 0, 20), {},
                         context),
      Cancelled);
}

}  // namespace
}  // namespace taut
