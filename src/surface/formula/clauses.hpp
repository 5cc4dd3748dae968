#pragma once

#include <string_view>

#include "surface/formula/expression.hpp"

namespace taut::detail {

/// What a text of clauses computes.
struct Clauses {
  NodeId root = kNoNode;    ///< of the last clause
  Index num_variables = 0;  ///< the largest of x, y, z in use, from 1; 0 = none
};

/// Reads `NAME OPERATION OPERAND...` a line into `graph`. Throws ParseError, which names the line.
[[nodiscard]] Clauses parse_clauses(std::string_view text, Graph& graph);

}  // namespace taut::detail
