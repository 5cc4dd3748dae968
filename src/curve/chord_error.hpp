#pragma once

#include "taut/core/types.hpp"
#include "taut/curve/flow.hpp"

namespace taut::detail {

/// Arc minus chord over chord for a chord of `cst` radii: acos(1 - cst^2 / 2) / cst - 1, to full relative accuracy. A
/// chord longer than the diameter counts as a half circle.
[[nodiscard]] double relative_chord_error(double cst);

/// The error model of the paper's Appendix II, evaluated on a polyline.
struct ChordError {
  double sum = 0;      ///< sum_i r_i acos(1 - eps_i^2 / (2 r_i^2)) - eps_i, model units
  double uniform = 0;  ///< (A1) with one Cst for the whole curve, model units
  double cst = 0;      ///< root mean square of eps_i / r_i weighted by eps_i
};

/// `nodes`: d x (m + 1), no two successive ones equal; the circles are those of osculating_circles.hpp.
[[nodiscard]] ChordError chord_error(const PointsIn& nodes);

/// What a summary says of the polyline itself: m, L, intervals, Cst and both errors.
[[nodiscard]] FlowSummary summarise(const PointsIn& nodes);
/// Fills in the time measured, K and (A2).
void set_seconds(double seconds, FlowSummary& summary);

}  // namespace taut::detail
