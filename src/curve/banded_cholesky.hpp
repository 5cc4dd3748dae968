#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Cholesky factorisation of a symmetric banded matrix, in place. Row r holds its entries left of the diagonal and the
/// diagonal itself; entry (r, c), r - width <= c <= r, is `at(r, c)`. O(n width^2), no allocation after `reset`.
class BandedCholesky {
 public:
  /// n x n zeros with `width` sub-diagonals.
  void reset(Index n, Index width) {
    n_ = n;
    width_ = width;
    data_.assign(static_cast<std::size_t>(n * (width + 1)), 0.0);
  }
  [[nodiscard]] Index size() const { return n_; }
  // Row r starts at r (width + 1) with entry c = r - width: r (width + 1) + c - (r - width).
  [[nodiscard]] double& at(Index r, Index c) { return data_[static_cast<std::size_t>(r * width_ + c + width_)]; }
  [[nodiscard]] double at(Index r, Index c) const { return data_[static_cast<std::size_t>(r * width_ + c + width_)]; }

  /// Returns the row of the first pivot that is not positive, or -1 when the matrix is positive definite and factored.
  [[nodiscard]] Index factor() {
    for (Index r = 0; r < n_; ++r) {
      // Entries left of the band stay zero: the factor has the band of the matrix.
      const Index first = std::max<Index>(0, r - width_);
      for (Index c = first; c <= r; ++c) {
        double sum = at(r, c);
        for (Index j = std::max(first, c - width_); j < c; ++j) sum -= at(r, j) * at(c, j);
        if (c < r) {
          at(r, c) = sum / at(c, c);
        } else if (sum > 0) {
          at(r, r) = std::sqrt(sum);
        } else {
          return r;
        }
      }
    }
    return -1;
  }

  /// Solves in place with the factor for every row of x at once: unknown r is column r (of n).
  void solve_rows(Eigen::Ref<Points> x) const {
    for (Index r = 0; r < n_; ++r) {
      // L z = x, then L^T x = z.
      for (Index c = std::max<Index>(0, r - width_); c < r; ++c) x.col(r).noalias() -= at(r, c) * x.col(c);
      x.col(r) /= at(r, r);
    }
    for (Index r = n_ - 1; r >= 0; --r) {
      x.col(r) /= at(r, r);
      for (Index c = std::max<Index>(0, r - width_); c < r; ++c) x.col(c).noalias() -= at(r, c) * x.col(r);
    }
  }

  /// Solves in place with the factor.
  void solve(Eigen::Ref<Vector> x) const {
    for (Index r = 0; r < n_; ++r) {
      double sum = x(r);
      for (Index c = std::max<Index>(0, r - width_); c < r; ++c) sum -= at(r, c) * x(c);
      x(r) = sum / at(r, r);
    }
    for (Index r = n_ - 1; r >= 0; --r) {
      x(r) /= at(r, r);
      for (Index c = std::max<Index>(0, r - width_); c < r; ++c) x(c) -= at(r, c) * x(r);
    }
  }

 private:
  Index n_ = 0;
  Index width_ = 0;
  std::vector<double> data_;
};

}  // namespace taut::detail
