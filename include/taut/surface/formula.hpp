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
  /// Names of the variables in place of x y z w or x1 x2 ..., in order; all of them count for the dimension.
  std::vector<std::string> variables = {};
  /// Parameters: names usable in the formula besides the variables, pi and e.
  std::map<std::string, double> parameters = {};
  /// Inequalities "lhs >= rhs" or "lhs <= rhs" that cut the surface.
  std::vector<std::string> domain = {};
  std::optional<Box> box = {};
};

/// Reads `lhs = rhs` or an expression meaning `= 0`, several equations separated by `;`, and compiles it.
/// The grammar, the functions, their value and derivative at kinks and poles, and the limits on size are documented in
/// docs/formula.md. Throws ParseError (with a caret under the column; UnknownName where a name means nothing) or
/// InvalidArgument.
[[nodiscard]] Surface parse_surface(std::string_view formula, const FormulaOptions& options = {});

/// The same for a function R^d -> R^m without the rule m < d: what a domain is made of. An inequality stands for what
/// it says is >= 0. `options.domain` and `options.box` play no part.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> parse_function(std::string_view formula,
                                                                     const FormulaOptions& options = {});

/// Reads clauses as fidget and libfive write them (.vm files): a line `NAME OPERATION OPERAND...` each, the last one is
/// F. Operations: const, var-x, var-y, var-z, add sub mul div min max atan2 pow, neg abs square sqrt recip exp ln sin
/// cos tan asin acos atan. It becomes a formula like any other: exact derivatives, interval bounds; min, max and abs
/// make it piecewise smooth, with the derivatives of the first branch where two meet. `options.dim` is 2 or more
/// (default: 3 where z is used, else 2); `options.parameters` serve the domain only. Throws ParseError, which names the
/// line, also for operations that jump (floor, compare, ...), and InvalidArgument.
[[nodiscard]] Surface parse_clauses(std::string_view clauses, const FormulaOptions& options = {});

/// Reads a scene, bodies defined one a line and put together on the last:
///     post = cylinder(0, 0, 1, 0.5, 2)    # what is behind # or // is a remark
///     smooth_union(box(0, 0, 0, 4, 2, 0.4), post, 0.2)
/// A definition is a name, = and an expression of what was defined before it; the last line is the surface, as in
/// `parse_surface`. A line goes on where a parenthesis is open. `options.parameters` stand in for definitions of the
/// same name, which must be numbers. Throws ParseError, which names the line, and InvalidArgument.
[[nodiscard]] Surface parse_scene(std::string_view text, const FormulaOptions& options = {});

}  // namespace taut
