#pragma once

#include <string_view>
#include <vector>

#include "surface/formula/expression.hpp"
#include "surface/formula/names.hpp"

namespace taut::detail {

/// Which statements a text may hold.
enum class Statements {
  equations,     ///< `lhs = rhs`, or an expression meaning `= 0`
  inequalities,  ///< `lhs >= rhs`, `lhs <= rhs`, `a <= b <= c`; > and < mean the same
  any,
};

/// Reads the statements of `text`, separated by `;`, into `graph` and returns one node for each: lhs - rhs, or what
/// must be >= 0. Keeps its own stack, so nesting is limited by memory alone. Throws ParseError.
[[nodiscard]] std::vector<NodeId> parse_statements(std::string_view text, Statements allowed, Names& names,
                                                   Graph& graph);

/// Reads one expression, which may be constant. Throws ParseError.
[[nodiscard]] NodeId parse_expression(std::string_view text, Names& names, Graph& graph);

}  // namespace taut::detail
