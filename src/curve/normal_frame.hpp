#pragma once

#include <Eigen/Core>

#include "surface/normal_space.hpp"

namespace taut::detail {

/// What HouseholderFrame does, without tangents: an orthonormal basis N (d x k) of the row space of a Jacobian J^T = N
/// R. O(d k^2) a point where the tangents would take O(d^2).
class NormalFrame {
 public:
  static constexpr int kD = Eigen::Dynamic;
  static constexpr int kK = Eigen::Dynamic;

  void resize(Eigen::Index d, Eigen::Index k) {
    normals_.resize(d, k);
    upper_.resize(k, k);
  }

  /// `gradients` is d x k: J^T. False when J loses rank or is not finite: |R_ii| at most 1e-11 |grad F_i|.
  bool compute(const Eigen::Ref<const Eigen::MatrixXd>& gradients) {
    const Eigen::Index k = gradients.cols();
    const Eigen::Index rank =
        NormalSpace<Eigen::Dynamic>::factor(gradients.rows(), k, gradients.data(), normals_.data(), upper_.data());
    if (rank < k) return false;
    for (Eigen::Index i = 0; i < k; ++i) {
      if (!(upper_(i, i) > 1e-11 * gradients.col(i).norm())) return false;
    }
    return true;
  }

  [[nodiscard]] const Eigen::MatrixXd& normals() const { return normals_; }  ///< d x k
  [[nodiscard]] auto first_normal() const { return normals_.col(0); }        ///< grad F_1 / |grad F_1|
  /// What of |grad F_i| the gradients before it do not span: zero where J loses rank.
  [[nodiscard]] double own_gradient(Eigen::Index i) const { return upper_(i, i); }

  /// J^+ value: the shortest step along which the linearised F changes by `value`.
  template <class Value>
  void pseudo_inverse(const Eigen::MatrixBase<Value>& value, Eigen::VectorXd& scratch,
                      Eigen::Ref<Eigen::VectorXd> step) const {
    scratch = value;
    NormalSpace<Eigen::Dynamic>::solve(upper_.cols(), upper_.data(), scratch.data(), scratch.data());
    step.noalias() = normals_ * scratch;
  }

  /// Multipliers of a force: the mu with normal part of force + J^T mu = 0.
  template <class Force>
  void multipliers(const Eigen::MatrixBase<Force>& force, Eigen::Ref<Eigen::VectorXd> mu) const {
    mu.noalias() = -(normals_.transpose() * force);
    upper_.triangularView<Eigen::Upper>().solveInPlace(mu);
  }

 private:
  Eigen::MatrixXd normals_;
  Eigen::MatrixXd upper_;
};

}  // namespace taut::detail
