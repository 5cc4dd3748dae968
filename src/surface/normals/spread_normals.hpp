#pragma once

#include <vector>

#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// The direction of least spread of the nearest `neighbours` of each of the points `at`, its sign arbitrary, d x |at|.
[[nodiscard]] Points least_spread(const Points& points, const KdTree& tree, const std::vector<Index>& at,
                                  Index neighbours, const Context& context);

/// How many neighbours tell the direction of a noisy sheet: doubled from `neighbours` on as long as that makes their
/// spread across the sheet clearly less beside the spread within. Where the shape bends, or the samples are clean, it
/// does not.
[[nodiscard]] Index neighbours_for_noise(const Points& points, const KdTree& tree, Index neighbours,
                                         const Context& context);

}  // namespace taut::detail
