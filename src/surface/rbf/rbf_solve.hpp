#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"

namespace taut::detail {

/// What F is asked to be, in the unit frame.
struct Constraints {
  Points at;                  ///< d x n, distinct
  Vector value;               ///< n
  std::vector<Index> sample;  ///< n: which sample each belongs to; those of one sample stand together
};

struct RbfSolution {
  Vector weights;  ///< n
  Vector polynomial;
  double residual = 0;  ///< largest |F - value| at the constraints (less what smoothing allows), unit frame
};

/// Solves for the polyharmonic spline through the constraints, in the form that minimises
///     energy(F) + sum over samples of (mean miss of the sample's constraints)^2 / ridge,
/// ridge = 0 being interpolation. A sample's constraints share one miss because a noisy sample is a shifted sample.
/// The polynomial is eliminated by Householder reflections, what remains is positive definite and solved by Cholesky
/// with iterative refinement against the evaluator. Throws InvalidArgument when the constraints do not determine the
/// polynomial, OutOfMemory before allocating too much.
[[nodiscard]] RbfSolution solve_rbf(RbfKernel kernel, const Constraints& constraints, double ridge,
                                    const Context& context);

}  // namespace taut::detail
