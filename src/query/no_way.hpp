#pragma once

#include <optional>

#include "taut/march/barrier.hpp"
#include "taut/query/path.hpp"

namespace taut::detail {

/// Says in `status` and `message` why no way was found from one end to the other though cells connect them: neither on
/// cells down to result.cell, nor by walks. `barrier`: where the last march stopped; `resolved`: do the cells follow
/// the surface.
void explain_no_way(PathResult& result, const Surface& surface, const std::optional<Barrier>& barrier, bool resolved);

}  // namespace taut::detail
