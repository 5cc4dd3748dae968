#pragma once

#include "curve/flow_nodes.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// How long the intervals of a curve may be, everywhere the least of three lengths.
struct IntervalRule {
  double longest = 0;     ///< eps_E, model units
  double per_radius = 0;  ///< of the curve's radius of curvature there: the paper's Cst = eps_i / r_i
  double per_turn = 0;    ///< radians that the surface's normal may turn along one
};

/// The intervals that `rule` asks for where those of the polyline are (m, model units). `turns`: m, see normal_turns.
/// From one to the next they change by no more than a quarter, since uneven steps would cost the vector triangle of
/// Figure 2 its second order.
[[nodiscard]] Vector wanted_intervals(const PointsIn& points, const VectorIn& turns, const IntervalRule& rule);

/// `num_intervals` of them along the polyline, in proportion to the wanted ones; the ends are the polyline's.
[[nodiscard]] FlowCurve spread_nodes(const PointsIn& points, const VectorIn& wanted, Index num_intervals);

}  // namespace taut::detail
