#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/types.hpp"

namespace taut::detail {

/// The thin QR factorisation J^T = Q R of a Jacobian (d x k, a gradient per column), by modified Gram-Schmidt done
/// twice ("twice is enough"): Q is orthonormal to rounding. D is d at compile time, or Eigen::Dynamic.
template <int D>
class NormalSpace {
 public:
  /// Q (d x k) and R (k x k, upper triangle, column-major) are written to the caller's memory. Returns k, or the first
  /// column that depends on the ones before it to rounding (a zero or non-finite one does, too).
  static Index factor(Index dim, Index k, const double* jacobian, double* q, double* r) {
    const Index d = D > 0 ? D : dim;
    for (Index i = 0; i < k; ++i) {
      const double* a = jacobian + i * d;
      double* qi = q + i * d;
      const double size = norm(d, a);
      if (!(size > 0) || !std::isfinite(size)) return i;
      for (Index c = 0; c < d; ++c) qi[c] = a[c];
      for (Index l = 0; l < i; ++l) r[l + i * k] = 0;
      for (int pass = 0; pass < (i > 0 ? 2 : 0); ++pass) {
        for (Index l = 0; l < i; ++l) {
          const double overlap = dot(d, q + l * d, qi);
          r[l + i * k] += overlap;
          for (Index c = 0; c < d; ++c) qi[c] -= overlap * q[l * d + c];
        }
      }
      const double rest = i > 0 ? norm(d, qi) : size;
      const double rank_threshold = 16 * static_cast<double>(d) * std::numeric_limits<double>::epsilon();
      if (!(rest > rank_threshold * size)) return i;
      r[i + i * k] = rest;
      for (Index c = 0; c < d; ++c) qi[c] /= rest;
    }
    return k;
  }

  /// y = R^-T f: the coordinates of J^+ f in the basis Q, so |y| = |J^+ f|.
  static void solve(Index k, const double* r, const double* f, double* y) {
    for (Index i = 0; i < k; ++i) {
      double rest = f[i];
      for (Index l = 0; l < i; ++l) rest -= r[l + i * k] * y[l];
      y[i] = rest / r[i + i * k];
    }
  }

  static double dot(Index dim, const double* a, const double* b) {
    const Index d = D > 0 ? D : dim;
    double sum = 0;
    for (Index c = 0; c < d; ++c) sum += a[c] * b[c];
    return sum;
  }

  /// Euclidean length, safe from overflow and underflow of the squares.
  static double norm(Index dim, const double* a) {
    const Index d = D > 0 ? D : dim;
    const double square = dot(d, a, a);
    if (square > 1e-280 && square < 1e280) return std::sqrt(square);
    double largest = 0;
    for (Index c = 0; c < d; ++c) {
      if (!std::isfinite(a[c])) return std::abs(a[c]);
      largest = std::max(largest, std::abs(a[c]));
    }
    if (largest == 0) return 0;
    double sum = 0;
    for (Index c = 0; c < d; ++c) sum += (a[c] / largest) * (a[c] / largest);
    return largest * std::sqrt(sum);
  }
};

}  // namespace taut::detail
