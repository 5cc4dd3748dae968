#include <gtest/gtest.h>

#include <cmath>

#include "curve/flow_solver.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/flow.hpp"

// Equation (4) and its beta, step by step.

namespace taut {
namespace {

/// A quarter of a great circle, its inner nodes lifted off the sphere by `lift`.
Points lifted_arc(Index m, double lift) {
  Points nodes(3, m + 1);
  for (Index i = 0; i <= m; ++i) {
    const double t = 1.5707963267948966 * static_cast<double>(i) / static_cast<double>(m);
    const double radius = i == 0 || i == m ? 1 : 1 + lift;
    nodes.col(i) << radius * std::cos(t), radius * std::sin(t), 0;
  }
  nodes.col(0) = Eigen::Vector3d(1, 0, 0);
  nodes.col(m) = Eigen::Vector3d(0, 1, 0);
  return nodes;
}

/// How far the middle node is off the sphere after `num_steps` explicit steps.
double off_after(int num_steps, double beta) {
  constexpr Index m = 16;
  const Surface sphere = test::unit_sphere();
  detail::CountingEvaluator evaluator(sphere);
  const FlowOptions options{.beta = beta, .time_step = FlowTimeStep::explicit_euler, .curvature_bound = 1e-12};
  const Context context;
  // One visit of all nodes for the start, one a step.
  detail::FlowSolver solver(evaluator, 3, 1, options, (num_steps + 1) * (m + 1), context);
  const detail::FlowState state = solver.relax({lifted_arc(m, 1e-4), Vector::Ones(m)}, 1e-12);
  EXPECT_EQ(solver.num_steps(), num_steps);
  return std::abs(state.nodes.points().col(m / 2).norm() - 1);
}

// p_t = -beta F grad F / |grad F|^2 across the surface: Euler's step of a quarter of Delta h^2 leaves 1 - beta / 4.
TEST(FlowSteps, BetaIsHowFastNodesAreDrawnToTheSurface) {
  for (const double beta : {0.1, 0.5, 1.0, 2.0}) {
    for (const int steps : {1, 5, 20}) {
      const double expected = 1e-4 * std::pow(1 - beta / 4, steps);
      EXPECT_NEAR(off_after(steps, beta), expected, 0.05 * expected + 2e-8) << "beta " << beta << ", " << steps;
    }
  }
  EXPECT_LT(off_after(3, 4), 1e-7) << "all the way in one step, up to the curvature of the surface";
}

TEST(FlowSteps, SmallBetaLeavesNodesOffForLonger) {
  Points start = lifted_arc(12, 0);
  for (Index i = 1; i < 12; ++i) start(2, i) = 0.05 * std::sin(static_cast<double>(i));
  FlowOptions options{.spacing = 0.15, .time_step = FlowTimeStep::explicit_euler};
  const FlowResult quick = correct_flow(test::unit_sphere(), start, options);
  options.beta = 0.01;
  const FlowResult slow = correct_flow(test::unit_sphere(), start, options);
  ASSERT_EQ(quick.status, Status::ok) << quick.reason;
  ASSERT_EQ(slow.status, Status::ok) << slow.reason;
  EXPECT_GT(slow.num_iterations, 5 * quick.num_iterations);
  EXPECT_NEAR(slow.length, quick.length, 1e-8) << "both come to rest on the same curve";
}

TEST(FlowSteps, ExplicitStepsRefuseABetaThatOvershoots) {
  const FlowOptions options{.beta = 4.1, .time_step = FlowTimeStep::explicit_euler};
  EXPECT_THROW((void)correct_flow(test::unit_sphere(), lifted_arc(12, 0), options), InvalidArgument);
}

TEST(FlowSteps, ImplicitStepsTakeAnyBetaAndOnlyTheWayChanges) {
  Points start = lifted_arc(20, 0);
  for (Index i = 1; i < 20; ++i) start(2, i) = 0.1 * std::sin(static_cast<double>(i));
  const FlowResult reference = correct_flow(test::unit_sphere(), start);
  for (const double beta : {1e-6, 0.05, 20.0, 1e6}) {
    const FlowResult result = correct_flow(test::unit_sphere(), start, {.beta = beta});
    EXPECT_EQ(result.status, Status::ok) << result.reason;
    EXPECT_NEAR(result.length, reference.length, 1e-9) << "beta = " << beta;
    if (beta < 1e-3) {
      EXPECT_GT(result.num_iterations, reference.num_iterations);
    }
  }
}

TEST(FlowSteps, WorkIsCountedAndEnds) {
  Points start = lifted_arc(20, 0);
  for (Index i = 1; i < 20; ++i) start(2, i) = 0.1 * std::sin(static_cast<double>(i));
  const FlowResult all = correct_flow(test::ellipsoid(1, 1, 0.3), start);
  ASSERT_EQ(all.status, Status::ok) << all.reason;
  EXPECT_GT(all.summary.num_evaluated, 0);
  for (const Index allowed : {Index{1}, all.summary.num_evaluated / 4, all.summary.num_evaluated / 2}) {
    const FlowResult result = correct_flow(test::ellipsoid(1, 1, 0.3), start, {.max_evaluated = allowed});
    EXPECT_EQ(result.status, Status::not_converged);
    EXPECT_EQ(result.reason, "the work allowed was used up before the curve came to rest");
    EXPECT_TRUE(result.points.allFinite());
    EXPECT_EQ(result.points.col(0), start.col(0));
    EXPECT_EQ(result.points.rightCols<1>(), start.rightCols<1>());
    // What was begun is finished: a few visits of every node more, not a run to the end.
    EXPECT_LT(result.summary.num_evaluated, allowed + 20 * result.points.cols());
  }
}

}  // namespace
}  // namespace taut
