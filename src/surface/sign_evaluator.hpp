#pragma once

#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// An evaluator of a domain that may know without its value on which side of the border a point lies: most points that
/// are asked about lie far from it.
class SignEvaluator : public Evaluator {
 public:
  /// Whether every component of F is >= 0 at each of n points (d x n), as `evaluate` would have it.
  virtual void are_nonnegative(Index n, const double* x, bool* answer) = 0;

 protected:
  using Evaluator::Evaluator;
};

/// The same of any evaluator of a function of `codim` components.
void are_nonnegative(Evaluator& evaluator, Index codim, Index n, const double* x, bool* answer);

}  // namespace taut::detail
