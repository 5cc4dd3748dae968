#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A polyline on a smooth surface in R^3, pulled taut within its domain: as short as it can get by moving sideways.
struct BorderBand {
  Points points;              ///< 3 x n, on the surface; none where it could not be kept there
  std::vector<int> touching;  ///< one a point: the component of the domain that it is pressed against; -1: none
  double length = 0;          ///< of the smooth curve through the points, model units
  double error = 0;           ///< of `length`, estimated: what half as many points say otherwise
  double outside = 0;         ///< how far parts of it lie beyond the border, model units
  bool settled = false;
};

/// Pulls `start` (3 x m, from one end to the other, near the surface and inside its domain) taut. It stays on the same
/// side of holes and gaps. `gap`: how far apart the points of `start` are, about; on the border, what is smaller by a
/// factor of 50 counts for nothing. Model units. The surface has k = 1 and a domain that is C^2 next to its border.
[[nodiscard]] BorderBand pull_taut(const Surface& surface, const Points& start, double gap, const Context& context);

}  // namespace taut::detail
