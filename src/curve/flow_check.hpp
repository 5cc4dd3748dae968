#pragma once

#include "curve/counting_evaluator.hpp"
#include "curve/flow_solver.hpp"
#include "taut/curve/flow.hpp"

namespace taut::detail {

/// How far the middles of intervals are off the surface, of the interval (m).
[[nodiscard]] Vector interval_jumps(CountingEvaluator& evaluator, Index dim, Index codim, const PointsIn& points);

/// Judges what the flow came to: residuals and error of `result`, whose points and summary are there, then its status.
/// `coarse_length`: of the same curve at about half as many nodes.
void check_flow(const Surface& surface, const FlowOptions& options, CountingEvaluator& evaluator,
                const FlowState& state, double coarse_length, FlowResult& result);

}  // namespace taut::detail
