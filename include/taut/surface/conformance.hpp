#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/box.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut {

struct ConformanceOptions {
  Index num_points = 64;   ///< random points of the box
  std::uint64_t seed = 1;  ///< the same seed checks the same points
  /// Largest error of a derivative against differences, relative to its size and to that of F over the box.
  double derivative_tolerance = 1e-6;
  Index max_violations = 20;  ///< stop collecting after so many
};

struct ConformanceViolation {
  std::string rule;    ///< "jacobian", "hessian", "symmetry", "hessian_times", "batch", "bounds", "nan", "exception"
  std::string detail;  ///< what was found and what was expected
  Vector point;        ///< d: where
};

struct ConformanceReport {
  std::vector<ConformanceViolation> violations;
  Index num_checks = 0;   ///< comparisons made
  Index num_skipped = 0;  ///< derivatives not compared: F is not finite there, or differences do not settle (a kink)

  [[nodiscard]] bool ok() const { return violations.empty(); }
  /// One line for each violation; "" when there is none.
  [[nodiscard]] std::string text() const;
};

/// Checks the identities that `Evaluator` promises, at random points and boxes inside `box`: for your own surface, in
/// your own tests.
///  - Jacobian against Ridders' extrapolated central differences of the value, weighted Hessian against those of the
///    Jacobian; the Hessian is exactly symmetric; hessian_times(v) = Hessian * v
///  - a batch equals its points one by one bit for bit, whatever is asked for together, and so does a second evaluator
///  - where `bounds` returns true, sampled values lie inside; NaN bounds are for boxes in which F is NaN everywhere
///  - where `jacobian_bounds` returns true, sampled Jacobians lie inside
///  - a NaN coordinate gives a NaN value; nothing is thrown for NaN, infinite and huge coordinates
/// Never throws for what `function` does wrong. Cost: some thousand evaluations a dimension.
[[nodiscard]] ConformanceReport check_conformance(const ImplicitFunction& function, const Box& box,
                                                  const ConformanceOptions& options = {});

}  // namespace taut
