#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cells/crossing.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// How far cells that the surface may cross reach on one side of an axis: the outer face of the outermost of
/// `last_level` inside `cells` (d x n coordinates at `level`, tested), in cells of level 0; empty when there is none.
/// Found best first, so that few cells are halved but those along the way; after too many, it is the outermost face not
/// yet refuted. `side`: -1 or 1.
[[nodiscard]] std::optional<std::int32_t> outermost_face(CrossingTest& test, Index dim,
                                                         const std::vector<std::int32_t>& cells, int level,
                                                         int last_level, Index axis, int side);

}  // namespace taut::detail
