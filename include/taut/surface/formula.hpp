#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "taut/surface/surface.hpp"

namespace taut {

struct FormulaOptions {
  /// Ambient dimension; unset = the largest variable used (x y z w, or x1 x2 ...), at least 2.
  std::optional<Index> dim = {};
  /// Parameters: names usable in the formula besides the variables, pi and e.
  std::map<std::string, double> parameters = {};
  /// Inequalities "lhs >= rhs" or "lhs <= rhs" that cut the surface.
  std::vector<std::string> domain = {};
  std::optional<Box> box = {};
};

/// Reads `lhs = rhs` or an expression meaning `= 0`, several equations separated by `;`, and compiles it.
/// The grammar, the functions, their value and derivative at kinks and poles, and the limits on size are documented in
/// docs/formula.md. Throws ParseError (with a caret under the column) or InvalidArgument.
[[nodiscard]] Surface parse_surface(std::string_view formula, const FormulaOptions& options = {});

/// The same for a function R^d -> R^m without the rule m < d: what a domain is made of. An inequality stands for what
/// it says is >= 0. `options.domain` and `options.box` play no part.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> parse_function(std::string_view formula,
                                                                     const FormulaOptions& options = {});

}  // namespace taut
