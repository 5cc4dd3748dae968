#pragma once

#include <cstdint>
#include <vector>

#include "cells/crossing_pool.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Those of the cells (d x n coordinates at a level) that the surface may cross, in the same order; tested on all
/// cores.
[[nodiscard]] std::vector<std::int32_t> crossed(CrossingPool& pool, Index dim, const std::vector<std::int32_t>& cells,
                                                int level, const Context& context);

}  // namespace taut::detail
