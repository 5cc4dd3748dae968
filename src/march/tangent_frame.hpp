#pragma once

#include <Eigen/Core>
#include <cmath>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Largest dimension marched: beyond it a cell has more than half a million neighbours.
inline constexpr int kMaxMarchDim = 12;

/// A vector of D entries, or of at most kMaxMarchDim when D is dynamic: never on the heap.
template <int D>
using SmallVector = Eigen::Matrix<double, D, 1, 0, D == Eigen::Dynamic ? kMaxMarchDim : D, 1>;

/// Orthonormal coordinates of the tangent space at a point, from an orthonormal basis N (d x k) of the normal space.
/// With the Householder reflections H_1, ..., H_k that carry N to the first k axes, the last d - k rows of H_k ... H_1
/// are an orthonormal basis of the tangent space: O(d k) a vector, no matrix is formed.
template <int D, int K>
class TangentFrame {
 public:
  TangentFrame(Index d, Index k) : d_(d), k_(k) {}

  /// Takes the orthonormal basis N (d x k, column-major).
  void set(const double* normals) {
    for (Index c = 0; c < codim(); ++c) {
      SmallVector<D> v = Eigen::Map<const SmallVector<D>>(normals + c * dim(), dim());
      for (Index b = 0; b < c; ++b) reflect(b, v);
      v.head(c).setZero();
      const double norm = v.norm();
      v(c) += std::copysign(norm, v(c));
      reflection_[c] = v;
      scale_[c] = 1 / (norm * std::abs(v(c)));
    }
  }

  [[nodiscard]] Index dim() const { return D == Eigen::Dynamic ? d_ : D; }
  [[nodiscard]] Index codim() const { return K == Eigen::Dynamic ? k_ : K; }

  /// The tangential part of w in tangent coordinates: entries k .. d - 1 of the result, the first k are zero.
  [[nodiscard]] SmallVector<D> coordinates(SmallVector<D> w) const {
    for (Index c = 0; c < codim(); ++c) reflect(c, w);
    w.head(codim()).setZero();
    return w;
  }
  /// The tangent vector in R^d with these coordinates.
  [[nodiscard]] SmallVector<D> lift(SmallVector<D> w) const {
    for (Index c = codim(); c-- > 0;) reflect(c, w);
    return w;
  }

 private:
  static constexpr int kMaxCodim = K == Eigen::Dynamic ? kMaxMarchDim : K;

  void reflect(Index c, SmallVector<D>& w) const { w -= (scale_[c] * reflection_[c].dot(w)) * reflection_[c]; }

  Index d_;
  Index k_;
  SmallVector<D> reflection_[kMaxCodim];
  double scale_[kMaxCodim];
};

}  // namespace taut::detail
