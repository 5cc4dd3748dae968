#pragma once

#include <algorithm>
#include <cmath>

#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// Do two points with these orthonormal bases of their normal spaces (d x k) lie on the same side of a thin body, as
/// far as normals tell: they turn by less than 60 degrees from one to the other.
template <class Basis, class OtherBasis>
[[nodiscard]] bool same_side(const Basis& normals, const OtherBasis& others) {
  constexpr double kCosine = 0.5;
  if (normals.cols() == 1) return normals.col(0).dot(others.col(0)) > kCosine;
  return (normals.transpose() * others).squaredNorm() > static_cast<double>(normals.cols() - 1) + kCosine * kCosine;
}

/// By how much the normal space turns from valid cell i to valid cell j, radians: at most pi, and above codimension 1
/// (where the principal angles are taken together) at most pi / 2.
[[nodiscard]] inline double normal_turn(const SurfaceCells& cells, Index i, Index j) {
  if (cells.codim() == 1) return std::acos(std::clamp(cells.normals(i).col(0).dot(cells.normals(j).col(0)), -1.0, 1.0));
  const Eigen::MatrixXd shared = cells.normals(i).transpose() * cells.normals(j);
  const double lost = static_cast<double>(cells.codim()) - shared.squaredNorm();
  return std::asin(std::sqrt(std::clamp(lost, 0.0, 1.0)));
}

}  // namespace taut::detail
