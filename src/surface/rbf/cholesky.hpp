#pragma once

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Factors A = L L^T in place: the lower triangle of the n x n column-major matrix `a` with leading dimension `stride`
/// becomes L; the strict upper triangle is not touched. Returns the number of columns factored before a pivot that is
/// not positive: n on success. Every element's sum runs in a fixed order with separate multiplication and addition, so
/// neither the processor's vector width nor the number of threads changes a bit.
[[nodiscard]] Index cholesky_in_place(double* a, Index n, Index stride, const Context& context);

/// Solves L L^T x = b in place.
void cholesky_solve(const double* l, Index n, Index stride, double* b);

}  // namespace taut::detail
