#pragma once

#include <vector>

#include "surface/formula/expression.hpp"

namespace taut::detail {

/// One structurally nonzero derivative: of row `row` by variable `column`.
struct Partial {
  std::uint32_t row;
  std::uint32_t column;
  NodeId node;
};

/// Derivatives are expressions too: made in the graph of the function, so that they share its parts and each other's,
/// and nothing that is zero whatever x is gets computed. A mask chooses the branch of min and max; where both sides are
/// equal it is the first one.

/// Gradient by reverse mode: d root / d variable for the variables 0 .. num_variables - 1 that occur. Rows are `row`.
void append_gradient(Graph& graph, NodeId root, std::uint32_t num_variables, std::uint32_t row,
                     std::vector<Partial>& result);

/// The same by forward mode: fewer operations where many intermediate results depend on few variables.
void append_gradient_forward(Graph& graph, NodeId root, std::uint32_t num_variables, std::uint32_t row,
                             std::vector<Partial>& result);

/// Hessian from a gradient: d (gradient entry) / d variable, lower triangle (row >= column). Returns false, with
/// `result` incomplete, when that takes more than `max_nodes` new nodes.
[[nodiscard]] bool append_hessian(Graph& graph, const std::vector<Partial>& gradient, std::size_t max_nodes,
                                  std::vector<Partial>& result);

/// Directional derivatives: for each gradient entry sum_j d entry / d x_j * direction_j, where direction_j is variable
/// number first_direction + j. Linear in the size of the gradient.
void append_directional(Graph& graph, const std::vector<Partial>& gradient, std::uint32_t num_variables,
                        std::uint32_t first_direction, std::vector<Partial>& result);

}  // namespace taut::detail
