#pragma once

#include "taut/core/types.hpp"

namespace taut::detail {

/// The polynomial part of a polyharmonic fit. Monomials in this order: 1, x_1 .. x_d, and for degree 2 then x_i x_j
/// with j <= i, row by row (x_1^2, x_2 x_1, x_2^2, ...).
struct PolynomialSpace {
  Index dim = 0;
  int degree = 1;  ///< 1 or 2

  [[nodiscard]] Index size() const { return 1 + dim + (degree == 2 ? dim * (dim + 1) / 2 : 0); }

  /// The monomials at x (d entries) into `out` (size() entries).
  void evaluate(const double* x, double* out) const {
    *out++ = 1;
    for (Index i = 0; i < dim; ++i) *out++ = x[i];
    if (degree < 2) return;
    for (Index i = 0; i < dim; ++i) {
      for (Index j = 0; j <= i; ++j) *out++ = x[i] * x[j];
    }
  }

  /// Adds value, gradient (d) and Hessian (d x d) of the polynomial with coefficients `c` to what is there; null
  /// outputs are skipped.
  void add(const double* c, const double* x, double* value, double* gradient, double* hessian) const {
    if (value != nullptr) {
      double sum = c[0];
      for (Index i = 0; i < dim; ++i) sum += c[1 + i] * x[i];
      *value += sum;
    }
    if (gradient != nullptr) {
      for (Index i = 0; i < dim; ++i) gradient[i] += c[1 + i];
    }
    if (degree < 2) return;
    const double* q = c + 1 + dim;
    for (Index i = 0; i < dim; ++i) {
      for (Index j = 0; j <= i; ++j, ++q) {
        if (value != nullptr) *value += *q * x[i] * x[j];
        if (gradient != nullptr) {
          gradient[i] += *q * x[j];
          gradient[j] += *q * x[i];
        }
        if (hessian != nullptr) {
          hessian[i * dim + j] += *q;
          hessian[j * dim + i] += *q;
        }
      }
    }
  }
};

}  // namespace taut::detail
