#pragma once

#include <limits>
#include <vector>

#include "curve/counting_evaluator.hpp"
#include "curve/flow_solver.hpp"
#include "curve/gap_insertion.hpp"
#include "curve/interval_rule.hpp"
#include "taut/curve/flow.hpp"

namespace taut::detail {

/// One geodesic correction, sec. 4 of the paper:
///  1. the start is projected onto the surface and pulled taut roughly, its nodes where its bends are (first_curve);
///  2. its length and its radii tell how long intervals are to be (choose_rule) and so how many there are: nodes are
///     spread accordingly, but coarser, at first so many that a few doublings lead to that number;
///  3. relax, put a node into every interval that is too long, and again, until none is (refine);
///  4. the result is judged (check_flow).
/// Every relaxation and every round of 3 counts evaluated nodes; when those allowed are used up, 4 follows.
class FlowCorrection {
 public:
  FlowCorrection(const Surface& surface, const FlowOptions& options, const Context& context);

  [[nodiscard]] FlowResult run(const PointsIn& start);

 private:
  [[nodiscard]] FlowState first_curve(const PointsIn& start);
  void cut_to_rule(Points& points, const IntervalRule& rule);
  [[nodiscard]] IntervalRule choose_rule(const Points& points) const;
  [[nodiscard]] FlowState refine(FlowState state, double& coarse_length);

  void project_nodes(Points& points);
  [[nodiscard]] FlowCurve with_widths(Points points, const IntervalRule& rule);
  /// Intervals along which the normal turns by more than `turn`, or whose middle is off the surface by much.
  [[nodiscard]] std::vector<bool> bent_intervals(const FlowNodes& nodes, double turn);
  [[nodiscard]] std::vector<bool> too_long(const FlowState& state);
  [[nodiscard]] double bound(double length, bool last) const;

  const Surface& surface_;
  FlowOptions options_;
  const Context& context_;
  CountingEvaluator evaluator_;
  FlowSolver solver_;
  GapInsertion insertion_;
  double last_error_ = std::numeric_limits<double>::infinity();  // by the sum of Appendix II, at the last scale
};

}  // namespace taut::detail
