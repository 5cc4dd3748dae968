#pragma once

#include <Eigen/Core>
#include <cmath>

namespace taut::detail {

/// An orthonormal frame of R^d split by a k x d Jacobian J of full rank: normals N (d x k, the row space of J) and
/// tangents T (d x q, q = d - k, its kernel), by Householder reflections of J^T = N R. Also solves with J.
/// D and K are the sizes at compile time, or Eigen::Dynamic. Nothing is allocated after `resize`.
template <int D, int K>
class HouseholderFrame {
 public:
  static constexpr int kD = D;
  static constexpr int kK = K;
  static constexpr int Q = D == Eigen::Dynamic || K == Eigen::Dynamic ? Eigen::Dynamic : D - K;
  using VectorD = Eigen::Matrix<double, D, 1>;
  using VectorK = Eigen::Matrix<double, K, 1>;

  void resize(Eigen::Index d, Eigen::Index k) {
    reflectors_.resize(d, k);
    beta_.resize(k);
    upper_.resize(k, k);
    full_.resize(d, d);
  }

  /// `gradients` is d x k: J^T. False when J loses rank or is not finite: |R_ii| at most 1e-11 |grad F_i|.
  template <class Gradients>
  bool compute(const Eigen::MatrixBase<Gradients>& gradients) {
    const Eigen::Index d = gradients.rows();
    const Eigen::Index k = gradients.cols();
    reflectors_ = gradients;
    for (Eigen::Index i = 0; i < k; ++i) {
      const double whole = gradients.col(i).norm();
      auto column = reflectors_.col(i).tail(d - i);
      const double norm = i == 0 ? whole : column.norm();
      if (!(norm > 1e-11 * whole) || !std::isfinite(norm)) return false;
      const double head = column(0);
      // The sign that does not cancel in head - pivot.
      const double pivot = head > 0 ? -norm : norm;
      column(0) = head - pivot;  // now H = I - beta v v^T
      // 2 / |v|^2 with |v|^2 = 2 norm (norm + |head|).
      beta_(i) = 1 / (norm * (norm + std::abs(head)));
      upper_.col(i).head(i) = reflectors_.col(i).head(i);
      upper_(i, i) = pivot;
      for (Eigen::Index j = i + 1; j < k; ++j) {
        const double dot = beta_(i) * column.dot(reflectors_.col(j).tail(d - i));
        reflectors_.col(j).tail(d - i) -= dot * column;
      }
    }
    // The product of the reflections; the first to be applied meets unit vectors.
    const auto last = reflectors_.col(k - 1).tail(d - k + 1);
    full_.setIdentity();
    for (Eigen::Index j = k - 1; j < d; ++j) full_.col(j).tail(d - k + 1) -= (beta_(k - 1) * last(j - k + 1)) * last;
    for (Eigen::Index i = k - 1; i-- > 0;) {
      const auto v = reflectors_.col(i).tail(d - i);
      for (Eigen::Index j = i; j < d; ++j) {
        const double dot = beta_(i) * v.dot(full_.col(j).tail(d - i));
        full_.col(j).tail(d - i) -= dot * v;
      }
    }
    return true;
  }

  [[nodiscard]] auto normals() const { return full_.template leftCols<K>(upper_.cols()); }                   ///< d x k
  [[nodiscard]] auto tangents() const { return full_.template rightCols<Q>(full_.cols() - upper_.cols()); }  ///< d x q

  /// grad F_1 / |grad F_1|.
  // R_11 is negative where the reflection turned the first gradient round.
  [[nodiscard]] auto first_normal() const { return (upper_(0, 0) < 0 ? -1.0 : 1.0) * full_.col(0); }

  /// What of |grad F_i| the gradients before it do not span: zero where J loses rank.
  [[nodiscard]] double own_gradient(Eigen::Index i) const { return std::abs(upper_(i, i)); }

  /// J^+ value: the shortest step along which the linearised F changes by `value`.
  template <class Value>
  void pseudo_inverse(const Eigen::MatrixBase<Value>& value, VectorK& scratch, Eigen::Ref<VectorD> step) const {
    scratch = value;
    solve_transposed(scratch);
    step.noalias() = normals() * scratch;
  }

  /// Multipliers of a force: the mu with normal part of force + J^T mu = 0.
  template <class Force>
  void multipliers(const Eigen::MatrixBase<Force>& force, Eigen::Ref<VectorK> mu) const {
    mu.noalias() = -(normals().transpose() * force);
    const Eigen::Index k = upper_.cols();
    for (Eigen::Index i = k; i-- > 0;) {
      for (Eigen::Index j = i + 1; j < k; ++j) mu(i) -= upper_(i, j) * mu(j);
      mu(i) /= upper_(i, i);
    }
  }

 private:
  void solve_transposed(VectorK& v) const {  // R^T v = v
    const Eigen::Index k = upper_.cols();
    for (Eigen::Index i = 0; i < k; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) v(i) -= upper_(j, i) * v(j);
      v(i) /= upper_(i, i);
    }
  }

  Eigen::Matrix<double, D, K> reflectors_;
  VectorK beta_;
  Eigen::Matrix<double, K, K> upper_;  // strictly lower part unused
  Eigen::Matrix<double, D, D> full_;   // normals, then tangents
};

}  // namespace taut::detail
