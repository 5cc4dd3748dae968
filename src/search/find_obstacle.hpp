#pragma once

#include <optional>

#include "march/barrier.hpp"
#include "taut/core/types.hpp"
#include "taut/search/doubt.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// What was tried before a way was given up.
struct Tried {
  double cell = 0;                 ///< h of the finest cells, model units
  std::optional<Barrier> barrier;  ///< where the last march stopped
  bool resolved = true;            ///< do the cells follow the surface
  bool walked = true;              ///< were walks tried, too
};

/// Why no way was found between two points (d each, on the surface) though the cells connect them.
[[nodiscard]] Obstacle find_obstacle(const Surface& surface, const Vector& from, const Vector& to, const Tried& tried);

}  // namespace taut::detail
