#include "surface/formula/affine.hpp"

#include <algorithm>
#include <cstddef>

#include "surface/formula/formula_function.hpp"

namespace taut::detail {
namespace {

/// Degree of a node as a polynomial: 0, 1, or more.
constexpr int kMore = 2;

int degree_of(const Node& node, const std::vector<int>& known) {
  const auto a = [&] { return known[node.a]; };
  const auto b = [&] { return known[node.b]; };
  switch (node.op) {
    case Op::constant: return 0;
    case Op::variable: return 1;
    case Op::negate: return a();
    case Op::add:
    case Op::subtract: return std::max(a(), b());
    case Op::multiply: return std::min(a() + b(), kMore);
    case Op::divide: return b() == 0 ? a() : kMore;
    default: return kMore;
  }
}

}  // namespace

std::vector<bool> affine_components(const ImplicitFunction& function) {
  std::vector<bool> affine(static_cast<std::size_t>(function.codim()), false);
  const auto* formula = dynamic_cast<const FormulaFunction*>(&function);
  if (formula == nullptr) return affine;
  const auto [graph, components] = formula->program().expressions();
  std::vector<int> degree(graph.size(), kMore);
  for (const NodeId id : graph.reachable(components)) degree[id] = degree_of(graph[id], degree);
  for (std::size_t i = 0; i < components.size() && i < affine.size(); ++i) affine[i] = degree[components[i]] < kMore;
  return affine;
}

}  // namespace taut::detail
