#pragma once

#include "taut/core/types.hpp"

namespace taut::detail {

/// Arc minus chord over chord for a chord of `cst` radii: acos(1 - cst^2 / 2) / cst - 1, to full relative accuracy. A
/// chord longer than the diameter counts as a half circle.
[[nodiscard]] double relative_chord_error(double cst);

/// The error model of the paper's Appendix II, evaluated on a polyline.
struct ChordError {
  double sum = 0;      ///< sum_i r_i acos(1 - eps_i^2 / (2 r_i^2)) - eps_i, model units
  double uniform = 0;  ///< (A1) with one Cst for the whole curve, model units
  double cst = 0;      ///< root mean square of eps_i / r_i weighted by eps_i
  double max_cst = 0;  ///< largest eps_i / r_i
};

/// `nodes`: d x (m + 1), no two successive ones equal. The osculating circle at a node comes from the vector triangle
/// of Figure 2, that of an interval is the mean of its nodes' curvatures.
[[nodiscard]] ChordError chord_error(const PointsIn& nodes);

}  // namespace taut::detail
