#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/linear_algebra.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

// How the normal space turns from one surface point to another, told by orthonormal bases N_a and N_b of both (d x k).
// With the principal angles a_i between them |N_a^T N_b|^2 = sum cos^2 a_i.

/// Sum of the squared sines of all principal angles; k = 1: of the angle between the two normals.
template <class Basis, class OtherBasis>
[[nodiscard]] double squared_sines(const Basis& a, const OtherBasis& b) {
  return static_cast<double>(a.cols()) - (a.transpose() * b).squaredNorm();
}

/// Radians. k = 1: between the normals with their signs, at most pi. Else all principal angles taken together, at most
/// pi / 2: no less than the largest of them.
template <class Basis, class OtherBasis>
[[nodiscard]] double normal_angle(const Basis& a, const OtherBasis& b) {
  if (a.cols() == 1) return std::acos(std::clamp(a.col(0).dot(b.col(0)), -1.0, 1.0));
  return std::asin(std::sqrt(std::clamp(squared_sines(a, b), 0.0, 1.0)));
}

/// Do the points lie on the same side of a thin body, as far as normals tell: they turn by less than 60 degrees.
template <class Basis, class OtherBasis>
[[nodiscard]] bool same_side(const Basis& a, const OtherBasis& b) {
  constexpr double kCosine = 0.5;
  if (a.cols() == 1) return a.col(0).dot(b.col(0)) > kCosine;
  return squared_sines(a, b) < 1 - kCosine * kCosine;
}

/// Is the one basis carried to the other without a reflection, by a turn of less than a right angle.
template <class Basis, class OtherBasis>
[[nodiscard]] bool same_orientation(const Basis& a, const OtherBasis& b) {
  if (a.cols() == 1) return a.col(0).dot(b.col(0)) > 0;
  return determinant(a.transpose() * b) > 0;
}

}  // namespace taut::detail
