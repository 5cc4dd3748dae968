#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/core/box.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut {

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
