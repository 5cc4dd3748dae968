#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

/// Why the Jacobian of a surface loses rank at a point. Equations are numbered from 0.
struct RankDiagnosis {
  /// What is wrong with one equation.
  enum class Fault {
    dependent,  ///< its gradient is a combination of those of `others`
    squared,    ///< it touches zero without crossing it and grows quadratically: written as a square
    root,  ///< it touches zero without crossing it and grows linearly: a root of a sum of squares, an absolute value
    undefined,  ///< it has no value on some sides of this point: the edge of where it is defined
    singular,   ///< its gradient vanishes, or is undefined, at this point: an apex, a cusp, a node
  };
  struct Finding {
    Fault fault = Fault::singular;
    Index equation = 0;
    std::vector<Index> others;  ///< for `dependent`, ascending
  };

  Vector point;                   ///< d
  std::vector<Finding> findings;  ///< never empty, by equation
  bool everywhere = false;        ///< the same at other points of the surface that were tried, not just here

  /// One line: which equations, where, and what to do. Equations are counted from 1.
  [[nodiscard]] std::string text() const;
};

/// Looks at the Jacobian at x (d), a point on or next to the surface. None where it has full rank, by a good margin,
/// and every equation crosses zero. Throws InvalidArgument for a wrong dimension or a point that is not finite.
[[nodiscard]] std::optional<RankDiagnosis> diagnose_rank(const ImplicitFunction& function, const VectorIn& x);

/// The same without a point: from a few points of `box` to the surface, by steps that need no full rank. None where
/// that leads to regular points or nowhere. k may be d or more here. Throws InvalidArgument for a wrong dimension.
[[nodiscard]] std::optional<RankDiagnosis> diagnose_rank(const ImplicitFunction& function, const Box& box);

}  // namespace taut
