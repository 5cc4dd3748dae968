#pragma once

#include <optional>

#include "taut/march/barrier.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// What was tried before a way was given up.
struct NoWay {
  std::optional<Barrier> barrier;  ///< where the last march stopped
  bool resolved = true;            ///< do the cells follow the surface
  bool walked = true;              ///< were walks tried, too
};

/// Says in `status` and `message` why no way was found from one end to the other, though cells down to result.cell
/// connect them.
void explain_no_way(PathResult& result, const Surface& surface, const NoWay& no_way);

}  // namespace taut::detail
