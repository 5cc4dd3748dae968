#pragma once

#include "surface/normal_angle.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// By how much the normal space turns from valid cell i to valid cell j, radians (see normal_angle).
[[nodiscard]] inline double normal_turn(const SurfaceCells& cells, Index i, Index j) {
  return normal_angle(cells.normals(i), cells.normals(j));
}

}  // namespace taut::detail
