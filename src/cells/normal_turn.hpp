#pragma once

#include <algorithm>
#include <cmath>

#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// By how much the normal space turns from valid cell i to valid cell j, radians: at most pi, and above codimension 1
/// (where the principal angles are taken together) at most pi / 2.
[[nodiscard]] inline double normal_turn(const SurfaceCells& cells, Index i, Index j) {
  const Eigen::MatrixXd shared = cells.normals(i).transpose() * cells.normals(j);
  if (cells.codim() == 1) return std::acos(std::clamp(shared(0), -1.0, 1.0));
  const double lost = static_cast<double>(cells.codim()) - shared.squaredNorm();
  return std::asin(std::sqrt(std::clamp(lost, 0.0, 1.0)));
}

}  // namespace taut::detail
