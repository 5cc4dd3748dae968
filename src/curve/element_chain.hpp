#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/linear_algebra.hpp"

namespace taut::detail {

/// Solves the symmetric systems of a curve made of m elements in a row, q unknowns a node, both ends fixed. Unknowns
/// inside an element are eliminated first (dense Cholesky, in place), which leaves a block tridiagonal system for the
/// m - 1 inner element ends, factored as L D L^T with q x q pivots D_j. By Sylvester's law the negative eigenvalues of
/// the pivots count the negative directions of the whole matrix; while D_1 .. D_{j-1} are positive definite, the matrix
/// is positive on everything that vanishes from element end j on.
///
/// Use: resize; fill `row`s and `end_block`/`end_right` of every element; condense every element; factor; solve.
template <int Q>
class ElementChain {
 public:
  using Block = Eigen::Matrix<double, Q, Q>;
  using Segment = Eigen::Matrix<double, Q, 1>;
  static constexpr int Q2 = Q == Eigen::Dynamic ? Eigen::Dynamic : 2 * Q;
  using EndBlock = Eigen::Matrix<double, Q2, Q2>;
  using EndSegment = Eigen::Matrix<double, Q2, 1>;

  void resize(int degree, Eigen::Index elements, Eigen::Index q) {
    q_ = q;
    inner_ = (degree - 1) * q;
    width_ = inner_ + 2 * q + 1;
    m_ = elements;
    rows_.resize(static_cast<std::size_t>(inner_ * width_ * m_));
    end_block_.resize(static_cast<std::size_t>(4 * q * q * m_));
    end_right_.resize(static_cast<std::size_t>(2 * q * m_));
    pivot_.resize(static_cast<std::size_t>(q * q * m_));
    link_.resize(static_cast<std::size_t>(q * q * m_));
    right_.resize(static_cast<std::size_t>(q * m_));
  }

  /// Before elements are filled.
  void start() {
    condensed_ = 0;
    first_failing_ = -1;
    negative_ = 0;
  }
  /// Were the inner unknowns of every element positive definite.
  [[nodiscard]] bool condensed() const { return condensed_ == m_; }

  [[nodiscard]] Eigen::Index width() const { return width_; }
  [[nodiscard]] Eigen::Index inner() const { return inner_; }
  /// Row i of the inner unknowns of element e: columns are inner unknowns (only from i on), left end, right end, right
  /// side.
  [[nodiscard]] double* row(Eigen::Index e, Eigen::Index i) { return rows_.data() + (e * inner_ + i) * width_; }
  [[nodiscard]] Eigen::Map<EndBlock> end_block(Eigen::Index e) {
    return Eigen::Map<EndBlock>(end_block_.data() + e * 4 * q_ * q_, 2 * q_, 2 * q_);
  }
  [[nodiscard]] Eigen::Map<EndSegment> end_right(Eigen::Index e) {
    return Eigen::Map<EndSegment>(end_right_.data() + e * 2 * q_, 2 * q_);
  }

  /// Eliminates the inner unknowns of element e: U^T U in its rows, the Schur complement in its end block. False when
  /// they are not positive definite.
  bool condense(Eigen::Index e) {
    constexpr int kHigh = Q == 2 ? 14 : Eigen::Dynamic;  // degree 8 on surfaces in space
    const bool definite = inner_ == kHigh ? eliminate_inner<kHigh>(e) : eliminate_inner<Eigen::Dynamic>(e);
    if (!definite) return false;
    auto block = end_block(e);
    auto right = end_right(e);
    for (Eigen::Index k = 0; k < inner_; ++k) {
      // Row k of U^-T B, B the couplings to the ends: the Schur complement is C - (U^-T B)^T (U^-T B), a row at a time.
      Eigen::Map<const EndSegment> ends(row(e, k) + inner_, 2 * q_);
      block.noalias() -= ends * ends.transpose();
      right -= ends * row(e, k)[width_ - 1];
    }
    ++condensed_;
    return true;
  }

  /// Factors the system of the element ends. With `definite` it stops at the first pivot block that is not positive
  /// definite and returns false. Without, it goes on with the indefinite block; false only for a singular or non-finite
  /// one.
  bool factor(bool definite) {
    negative_ = 0;
    first_failing_ = -1;
    for (Eigen::Index j = 1; j < m_; ++j) {
      Eigen::Map<Block> pivot = block_of(pivot_, j);
      Eigen::Map<Segment> right = segment(j);
      // D_j = A_jj - B_{j-1}^T D_{j-1}^-1 B_{j-1}; the link kept is D_j^-1 B_j.
      pivot = end_block(j - 1).bottomRightCorner(q_, q_) + end_block(j).topLeftCorner(q_, q_);
      right = end_right(j - 1).tail(q_) + end_right(j).head(q_);
      if (j > 1) {
        const auto above = end_block(j - 1).topRightCorner(q_, q_);
        pivot.noalias() -= above.transpose() * block_of(link_, j - 1);
        right.noalias() -= above.transpose() * segment(j - 1);
      }
      Eigen::Map<Block> link = block_of(link_, j);
      link = end_block(j).topRightCorner(q_, q_);
      // Success with a NaN on the diagonal would pass for positive definite: hence the second look.
      cholesky_.compute(pivot);
      if (cholesky_.info() == Eigen::Success && pivot.diagonal().allFinite()) {
        cholesky_.solveInPlace(link);
        cholesky_.solveInPlace(right);
        continue;
      }
      if (first_failing_ < 0) first_failing_ = j;
      if (definite || !pivot.allFinite()) return false;
      const auto eigen = symmetric_eigen(Block(pivot));
      const double largest = eigen.values.cwiseAbs().maxCoeff();
      // Singular to rounding: the curve ends in a conjugate point, and no solution is worth having.
      if (!(eigen.values.cwiseAbs().minCoeff() > 1e-14 * largest)) return false;
      negative_ += static_cast<int>((eigen.values.array() < 0).count());
      const Block inverse = eigen.vectors * eigen.values.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
      link = (inverse * link).eval();
      right = (inverse * right).eval();
    }
    return true;
  }

  /// Negative directions found by factor(false).
  [[nodiscard]] int num_negative() const { return negative_; }
  /// The element end (1 .. m - 1) whose pivot was the first not to be positive definite, or -1.
  [[nodiscard]] Eigen::Index first_failing() const { return first_failing_; }

  /// The solution at all nodes, q x (m degree + 1), zero at both ends.
  void solve(double* y) {
    const Eigen::Index stride = inner_ + q_;
    Eigen::Map<Eigen::VectorXd>(y, q_).setZero();
    Eigen::Map<Eigen::VectorXd>(y + m_ * stride, q_).setZero();
    for (Eigen::Index j = m_ - 1; j >= 1; --j) {
      Eigen::Map<Segment> value(y + j * stride, q_);
      value = segment(j);
      if (j + 1 < m_) value.noalias() -= block_of(link_, j) * Eigen::Map<const Segment>(y + (j + 1) * stride, q_);
    }
    for (Eigen::Index e = 0; e < m_; ++e) back_substitute(e, y, 1);
  }

  /// Least eigenvalue of the pivot of element end j, after factor(true).
  [[nodiscard]] double least_pivot(Eigen::Index j) {
    const Eigen::Map<Block> pivot = block_of(pivot_, j);
    if constexpr (Q == 2) {
      return (pivot.trace() - std::hypot(pivot(0, 0) - pivot(1, 1), 2 * pivot(0, 1))) / 2;
    } else {
      return symmetric_eigenvalues(Block(pivot))(0);
    }
  }

  /// The direction v of least v^T A v at element end j that vanishes from the next one on, q x (m degree + 1), where
  /// the ends before j have positive definite pivots: of several, with pivots that differ by less than `level`, the
  /// one that leads down. Returns v^T A v.
  double soft_direction(Eigen::Index j, double level, double* v) {
    const Eigen::Index stride = inner_ + q_;
    Eigen::Map<Eigen::VectorXd>(v, m_ * stride + q_).setZero();
    const Eigen::Map<Block> pivot = block_of(pivot_, j);
    const auto eigen = symmetric_eigen(Block(pivot));
    // Where the pivot failed, the right side was left as it was; else it holds D_j^-1 times it.
    const Segment load = first_failing_ == j ? Segment(segment(j)) : Segment(pivot * segment(j));
    Segment here = Segment::Zero(q_);
    for (Eigen::Index i = 0; i < q_ && eigen.values(i) <= eigen.values(0) + level; ++i) {
      here += eigen.vectors.col(i).dot(load) * eigen.vectors.col(i);
    }
    here.normalize();
    double curvature = here.dot(pivot * here);
    // No load in these directions, or it leads where the energy rises although another direction falls: the softest
    // one.
    if (!(here.norm() > 0.5) || (curvature > 0 && eigen.values(0) < 0)) {
      here = eigen.vectors.col(0);
      curvature = eigen.values(0);
    }
    Eigen::Map<Segment>(v + j * stride, q_) = here;
    for (Eigen::Index i = j - 1; i >= 1; --i) {
      Eigen::Map<Segment>(v + i * stride, q_).noalias() =
          -(block_of(link_, i) * Eigen::Map<const Segment>(v + (i + 1) * stride, q_));
    }
    for (Eigen::Index e = 0; e <= j; ++e) back_substitute(e, v, 0);
    return curvature;
  }

  /// Inner unknowns of element e from those at its ends; `load` is 0 for a homogeneous system, else 1.
  void back_substitute(Eigen::Index e, double* y, double load) {
    double* left = y + e * (inner_ + q_);
    double* inside = left + q_;
    const double* end = inside + inner_;
    for (Eigen::Index k = inner_; k-- > 0;) {
      const double* r = row(e, k);
      double sum = load * r[width_ - 1];
      for (Eigen::Index j = 0; j < q_; ++j) sum -= r[inner_ + j] * left[j] + r[inner_ + q_ + j] * end[j];
      for (Eigen::Index j = k + 1; j < inner_; ++j) sum -= r[j] * inside[j];
      inside[k] = sum / r[k];
    }
  }

 private:
  // U^T U of the inner unknowns, applied to the columns of both ends and the right side. `Inner` is their number where
  // it is known at compile time.
  template <int Inner>
  bool eliminate_inner(Eigen::Index e) {
    const Eigen::Index inner = Inner == Eigen::Dynamic ? inner_ : Inner;
    const Eigen::Index w = Inner == Eigen::Dynamic ? width_ : Inner + 2 * Q + 1;
    // Rows do not overlap; said so, the compiler keeps the inner loop in vector registers.
    double* __restrict rows = row(e, 0);
    for (Eigen::Index k = 0; k < inner; ++k) {
      double* __restrict pivot_row = rows + k * w;
      const double pivot = pivot_row[k];
      if (!(pivot > 0)) return false;
      const double scale = 1 / std::sqrt(pivot);
      for (Eigen::Index j = k; j < w; ++j) pivot_row[j] *= scale;
      for (Eigen::Index i = k + 1; i < inner; ++i) {
        double* __restrict target = rows + i * w;
        const double factor = pivot_row[i];
        for (Eigen::Index j = i; j < w; ++j) target[j] -= factor * pivot_row[j];
      }
    }
    return true;
  }

  [[nodiscard]] Eigen::Map<Block> block_of(std::vector<double>& store, Eigen::Index j) const {
    return Eigen::Map<Block>(store.data() + j * q_ * q_, q_, q_);
  }
  [[nodiscard]] Eigen::Map<Segment> segment(Eigen::Index j) { return Eigen::Map<Segment>(right_.data() + j * q_, q_); }

  Eigen::Index q_ = 0;
  Eigen::Index inner_ = 0;
  Eigen::Index width_ = 0;
  Eigen::Index m_ = 0;
  std::vector<double> rows_;
  std::vector<double> end_block_;
  std::vector<double> end_right_;
  std::vector<double> pivot_;
  std::vector<double> link_;
  std::vector<double> right_;
  Eigen::LLT<Block> cholesky_;
  int negative_ = 0;
  Eigen::Index condensed_ = 0;
  Eigen::Index first_failing_ = -1;
};

}  // namespace taut::detail
