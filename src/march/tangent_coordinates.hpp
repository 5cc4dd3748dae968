#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Largest dimension marched: beyond it a cell has more than half a million neighbours.
inline constexpr int kMaxMarchDim = 12;

/// A vector of D entries, or of at most kMaxMarchDim when D is dynamic: never on the heap.
template <int D, class Scalar = double>
using SmallVector = Eigen::Matrix<Scalar, D, 1, 0, D == Eigen::Dynamic ? kMaxMarchDim : D, 1>;

/// Orthonormal coordinates of the tangent space at a point, from an orthonormal basis N (d x k) of the normal space.
/// With the Householder reflections H_1, ..., H_k that carry N to the first k axes, the last d - k rows of H_k ... H_1
/// are an orthonormal basis of the tangent space: O(d k) a vector, no matrix is formed.
template <int D, int K>
class TangentCoordinates {
 public:
  TangentCoordinates(Index d, Index k) : d_(d), k_(k) {}

  /// Takes the orthonormal basis N (d x k, column-major).
  void set(const double* normals) {
    for (Index c = 0; c < codim(); ++c) {
      SmallVector<D> v = Eigen::Map<const SmallVector<D>>(normals + c * dim(), dim());
      for (Index b = 0; b < c; ++b) reflect(b, v);
      // The normals are orthonormal: the reflections before have left nothing there but rounding.
      v.head(c).setZero();
      const double norm = v.norm();
      handedness_ = (c > 0 ? handedness_ : 1) * std::copysign(1.0, v(c));
      v(c) += std::copysign(norm, v(c));
      reflection_[c] = v;
      // One reflection carries the normal n to -sign(n_1) e_1 and turns the frame's orientation round.
      if constexpr (D == 3 && K == 1)
        axis_ = std::copysign(1.0, normals[0]) * Eigen::Map<const SmallVector<D>>(normals, 3);
      // 2 / |v|^2: with |v| = norm before the shift, |v|^2 = 2 norm |v(c)| after it.
      scale_[c] = 1 / (norm * std::abs(v(c)));
    }
  }

  [[nodiscard]] Index dim() const { return D == Eigen::Dynamic ? d_ : D; }
  [[nodiscard]] Index codim() const { return K == Eigen::Dynamic ? k_ : K; }

  /// 1 where the normals followed by the tangent coordinates' axes are right-handed, -1 where they are left-handed.
  [[nodiscard]] double handedness() const { return handedness_; }

  /// The tangential part of w in tangent coordinates: entries k .. d - 1 of the result, the first k are zero.
  [[nodiscard]] SmallVector<D> coordinates(SmallVector<D> w) const {
    for (Index c = 0; c < codim(); ++c) reflect(c, w);
    w.head(codim()).setZero();
    return w;
  }
  /// The tangent vector in R^d with these coordinates.
  [[nodiscard]] SmallVector<D> lift(SmallVector<D> w) const {
    // Reflections are their own inverses: the same ones in reverse.
    for (Index c = codim(); c-- > 0;) reflect(c, w);
    return w;
  }

  /// d - k = 2: the cross product a x b of the tangential parts of a and b, in tangent coordinates.
  [[nodiscard]] double cross(const SmallVector<D>& a, const SmallVector<D>& b) const {
    if constexpr (D == 3 && K == 1) return a.cross(b).dot(axis_);
    const Index k = codim();
    const SmallVector<D> s = coordinates(a);
    const SmallVector<D> t = coordinates(b);
    return s(k) * t(k + 1) - s(k + 1) * t(k);
  }

 private:
  static constexpr int kMaxCodim = K == Eigen::Dynamic ? kMaxMarchDim : K;

  void reflect(Index c, SmallVector<D>& w) const { w -= (scale_[c] * reflection_[c].dot(w)) * reflection_[c]; }

  Index d_;
  Index k_;
  SmallVector<D> reflection_[kMaxCodim];
  double scale_[kMaxCodim];
  double handedness_ = 1;
  SmallVector<D> axis_;  // d = 3, k = 1: +-n, such that the frame is right-handed about it
};

}  // namespace taut::detail
