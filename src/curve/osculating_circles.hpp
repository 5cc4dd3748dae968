#pragma once

#include "taut/core/types.hpp"

namespace taut::detail {

/// eps_i: lengths of the m intervals of a polyline (d x (m + 1)), model units.
[[nodiscard]] Vector interval_lengths(const PointsIn& nodes);

/// 1 / r_i: curvatures of the osculating circles of the m intervals, 1 / model units. That at a node comes from the
/// vector triangle of the paper's Figure 2, that of an interval is the mean of its two nodes'. No two successive nodes
/// may be equal.
[[nodiscard]] Vector interval_curvatures(const PointsIn& nodes);

}  // namespace taut::detail
