#include "surface/formula/derivative.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace taut::detail {
namespace {

/// Arithmetic in which zero is structural: 0 * anything = 0.
class Calculus {
 public:
  explicit Calculus(Graph& g) : graph(g), zero(g.constant(0)), one(g.constant(1)) {}

  NodeId times(NodeId a, NodeId b) { return a == zero || b == zero ? zero : graph.multiply(a, b); }
  NodeId plus(NodeId a, NodeId b) { return a == zero ? b : b == zero ? a : graph.add(a, b); }
  NodeId over(NodeId a, NodeId b) { return a == zero ? zero : graph.divide(a, b); }
  NodeId choose(NodeId mask, NodeId a, NodeId b) { return graph.choose(mask, a, b); }

  /// Condition under which the first operand of a minimum or maximum is the one taken.
  NodeId takes_first(const Node& node) {
    return node.op == Op::minimum ? graph.less_equal(node.a, node.b) : graph.less_equal(node.b, node.a);
  }

  /// d node / d a for operations of one operand; `id` is the node itself, whose value many derivatives reuse.
  NodeId slope(NodeId id) {
    const Node node = graph[id];
    const NodeId a = node.a;
    switch (node.op) {
      case Op::negate: return graph.constant(-1);
      case Op::absolute: return graph.unary(Op::sign, a);
      case Op::square: return graph.multiply(a, graph.constant(2));
      case Op::odd_power: return graph.multiply(graph.power(a, graph.constant(node.b - 1.0)), graph.constant(node.b));
      case Op::sqrt: return graph.divide(graph.constant(0.5), id);
      case Op::cbrt: return graph.divide(one, graph.multiply(graph.constant(3), graph.square(id)));
      case Op::exp: return id;
      case Op::log:
        return graph.choose(graph.less_equal(zero, a), graph.divide(one, a),
                            graph.constant(std::numeric_limits<double>::quiet_NaN()));
      case Op::sin: return graph.unary(Op::cos, a);
      case Op::cos: return graph.negate(graph.unary(Op::sin, a));
      case Op::tan: return graph.add(graph.square(id), one);
      case Op::asin: return graph.divide(one, half_circle(a));
      case Op::acos: return graph.divide(graph.constant(-1), half_circle(a));
      case Op::atan: return graph.divide(one, graph.add(graph.square(a), one));
      case Op::sinh: return graph.unary(Op::cosh, a);
      case Op::cosh: return graph.unary(Op::sinh, a);
      case Op::tanh: return graph.subtract(one, graph.square(id));
      default: return zero;  // sign is constant wherever it has a derivative
    }
  }

  /// The factors f, g with d(a op b) = f da + g db, for operations that are smooth in both operands.
  std::pair<NodeId, NodeId> slopes(NodeId id) {
    const Node node = graph[id];
    const NodeId a = node.a;
    const NodeId b = node.b;
    switch (node.op) {
      case Op::multiply: return {b, a};
      case Op::divide: {
        if (graph.is_constant(b)) return {graph.divide(one, b), zero};
        return {graph.divide(one, b), graph.negate(graph.divide(id, b))};
      }
      case Op::power: {
        const NodeId by_base = graph.is_constant(a) ? zero : graph.multiply(b, graph.power(a, graph.subtract(b, one)));
        if (graph.is_constant(b)) return {by_base, zero};
        // a^b log a, whose limit where a^b vanishes is 0.
        const NodeId vanishes = graph.less_equal(graph.unary(Op::absolute, id), zero);
        return {by_base, graph.choose(vanishes, zero, graph.multiply(id, graph.unary(Op::log, a)))};
      }
      case Op::atan2: {
        const NodeId r2 = graph.add(graph.square(a), graph.square(b));
        return {graph.divide(b, r2), graph.negate(graph.divide(a, r2))};
      }
      default: return {zero, zero};
    }
  }

  Graph& graph;
  const NodeId zero;
  const NodeId one;

 private:
  /// sqrt(1 - a^2), without cancellation near |a| = 1.
  NodeId half_circle(NodeId a) {
    return graph.unary(Op::sqrt, graph.multiply(graph.subtract(one, a), graph.add(a, one)));
  }
};

/// Tangent of one node from those of its operands.
template <class TangentOf>
NodeId tangent(Calculus& c, NodeId id, const TangentOf& of) {
  const Node node = c.graph[id];
  switch (node.op) {
    case Op::constant:
    case Op::variable: return c.zero;
    case Op::add: return c.plus(of(node.a), of(node.b));
    case Op::subtract: {
      const NodeId b = of(node.b);
      return b == c.zero ? of(node.a) : c.graph.subtract(of(node.a), b);
    }
    case Op::minimum:
    case Op::maximum: {
      const NodeId a = of(node.a);
      const NodeId b = of(node.b);
      return a == b ? a : c.choose(c.takes_first(node), a, b);
    }
    case Op::choose: return c.choose(node.a, of(node.b), of(node.c));
    case Op::keep: return c.choose(node.a, of(node.b), c.zero);
    case Op::drop: return c.choose(node.a, c.zero, of(node.b));
    case Op::less_equal: return c.zero;
    default: break;
  }
  const NodeId a = of(node.a);
  if (operand_count(node.op) == 1) return a == c.zero ? c.zero : c.times(a, c.slope(id));
  const NodeId b = of(node.b);
  if (a == c.zero && b == c.zero) return c.zero;
  if (node.op == Op::divide) {
    // (da - q db) / b: one division
    if (b == c.zero) return c.over(a, node.b);
    const NodeId moved = c.times(id, b);
    return c.graph.divide(a == c.zero ? c.graph.negate(moved) : c.graph.subtract(a, moved), node.b);
  }
  const auto [f, g] = c.slopes(id);
  return c.plus(c.times(a, f), c.times(b, g));
}

/// For each of the first `count` nodes the nodes that use it, in compressed rows.
struct Users {
  std::vector<std::uint32_t> begin;
  std::vector<NodeId> users;

  Users(const Graph& graph, const std::vector<NodeId>& order, std::size_t count) : begin(count + 1, 0) {
    const auto each_edge = [&](const auto& visit) {
      for (const NodeId id : order) {
        const Node& node = graph[id];
        const NodeId operands[3] = {node.a, node.b, node.c};
        for (int i = 0; i < operand_count(node.op); ++i) visit(operands[i], id);
      }
    };
    each_edge([&](NodeId operand, NodeId) { ++begin[operand + 1]; });
    for (std::size_t i = 0; i < count; ++i) begin[i + 1] += begin[i];
    users.resize(begin[count]);
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    each_edge([&](NodeId operand, NodeId id) { users[next[operand]++] = id; });
  }
};

/// Nodes in `order` that depend on `start`, in evaluation order; `start` itself first.
std::vector<NodeId> dependents(const Users& users, NodeId start, std::vector<bool>& seen) {
  std::vector<NodeId> found{start};
  seen[start] = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::uint32_t j = users.begin[found[i]]; j < users.begin[found[i] + 1]; ++j) {
      const NodeId user = users.users[j];
      if (seen[user]) continue;
      seen[user] = true;
      found.push_back(user);
    }
  }
  for (const NodeId id : found) seen[id] = false;
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<NodeId> roots_of(const std::vector<Partial>& partials) {
  std::vector<NodeId> roots;
  for (const Partial& partial : partials) roots.push_back(partial.node);
  return roots;
}

std::size_t end_of(const std::vector<NodeId>& order) { return order.empty() ? 0 : order.back() + std::size_t{1}; }

}  // namespace

void append_gradient(Graph& graph, NodeId root, std::uint32_t num_variables, std::uint32_t row,
                     std::vector<Partial>& result) {
  Calculus c(graph);
  const std::vector<NodeId> order = graph.reachable({root});
  // The sub-graph is small against the graph when there are many equations: adjoints by position in it.
  const auto position = [&](NodeId id) {
    return static_cast<std::size_t>(std::lower_bound(order.begin(), order.end(), id) - order.begin());
  };
  std::vector<NodeId> adjoint(order.size(), c.zero);
  std::vector<bool> varies(order.size());  // depends on a variable to differentiate by
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Node& node = graph[order[i]];
    const int operands = operand_count(node.op);
    varies[i] = node.op == Op::variable
                    ? node.a < num_variables
                    : (operands > 0 && varies[position(node.a)]) || (operands > 1 && varies[position(node.b)]) ||
                          (operands > 2 && varies[position(node.c)]);
  }
  adjoint.back() = c.one;
  for (std::size_t i = order.size(); i-- > 0;) {
    const NodeId id = order[i];
    const Node node = graph[id];
    const NodeId bar = adjoint[i];
    if (bar == c.zero || !varies[i]) continue;
    const auto pass = [&](NodeId operand, const auto& contribution) {
      const std::size_t p = position(operand);
      if (varies[p]) adjoint[p] = c.plus(adjoint[p], contribution());
    };
    switch (node.op) {
      case Op::variable: result.push_back({row, node.a, bar}); continue;
      case Op::add:
        pass(node.a, [&] { return bar; });
        pass(node.b, [&] { return bar; });
        continue;
      case Op::subtract:
        pass(node.a, [&] { return bar; });
        pass(node.b, [&] { return graph.negate(bar); });
        continue;
      case Op::minimum:
      case Op::maximum:
        pass(node.a, [&] { return c.choose(c.takes_first(node), bar, c.zero); });
        pass(node.b, [&] { return c.choose(c.takes_first(node), c.zero, bar); });
        continue;
      case Op::divide: {
        const NodeId share = graph.divide(bar, node.b);
        pass(node.a, [&] { return share; });
        pass(node.b, [&] { return graph.negate(c.times(share, id)); });
        continue;
      }
      default: break;
    }
    if (operand_count(node.op) == 1) {
      pass(node.a, [&] { return c.times(bar, c.slope(id)); });
    } else {
      const auto [f, g] = c.slopes(id);
      pass(node.a, [&, f = f] { return c.times(bar, f); });
      pass(node.b, [&, g = g] { return c.times(bar, g); });
    }
  }
}

void append_gradient_forward(Graph& graph, NodeId root, std::uint32_t num_variables, std::uint32_t row,
                             std::vector<Partial>& result) {
  Calculus c(graph);
  const std::vector<NodeId> order = graph.reachable({root});
  const std::size_t count = end_of(order);
  const Users users(graph, order, count);
  std::vector<NodeId> tangents(count, c.zero);
  std::vector<bool> seen(count);
  for (const NodeId start : order) {
    if (graph[start].op != Op::variable || graph[start].a >= num_variables) continue;
    const std::vector<NodeId> touched = dependents(users, start, seen);
    tangents[start] = c.one;
    for (const NodeId id : touched) {
      if (id != start) tangents[id] = tangent(c, id, [&](NodeId operand) { return tangents[operand]; });
    }
    if (tangents[root] != c.zero) result.push_back({row, graph[start].a, tangents[root]});
    for (const NodeId id : touched) tangents[id] = c.zero;
  }
}

bool append_hessian(Graph& graph, const std::vector<Partial>& gradient, std::size_t max_nodes,
                    std::vector<Partial>& result) {
  Calculus c(graph);
  const std::vector<NodeId> order = graph.reachable(roots_of(gradient));
  const std::size_t count = end_of(order);
  const std::size_t limit = graph.size() + max_nodes;
  const Users users(graph, order, count);
  std::vector<NodeId> tangents(count, c.zero);
  std::vector<bool> seen(count);

  // Gradient entries by their node, so that only those a variable reaches are looked at.
  std::vector<std::pair<NodeId, std::uint32_t>> entries;
  for (const Partial& partial : gradient) entries.emplace_back(partial.node, partial.column);
  std::sort(entries.begin(), entries.end());

  for (const Partial& by : gradient) {
    const NodeId start = graph.variable(by.column);
    if (start >= count) continue;  // linear in this variable
    const std::vector<NodeId> touched = dependents(users, start, seen);
    tangents[start] = c.one;
    for (const NodeId id : touched) {
      if (id != start) tangents[id] = tangent(c, id, [&](NodeId operand) { return tangents[operand]; });
      if (graph.size() > limit) return false;
    }
    for (const NodeId id : touched) {
      if (tangents[id] != c.zero) {
        for (auto entry = std::lower_bound(entries.begin(), entries.end(), std::pair{id, std::uint32_t{0}});
             entry != entries.end() && entry->first == id; ++entry) {
          if (entry->second >= by.column) result.push_back({entry->second, by.column, tangents[id]});
        }
      }
    }
    for (const NodeId id : touched) tangents[id] = c.zero;
    if (result.size() > max_nodes) return false;
  }
  return true;
}

void append_directional(Graph& graph, const std::vector<Partial>& gradient, std::uint32_t num_variables,
                        std::uint32_t first_direction, std::vector<Partial>& result) {
  Calculus c(graph);
  const std::vector<NodeId> order = graph.reachable(roots_of(gradient));
  std::vector<NodeId> tangents(end_of(order), c.zero);
  for (const NodeId id : order) {
    const Node node = graph[id];
    if (node.op == Op::variable) {
      if (node.a < num_variables) tangents[id] = graph.variable(first_direction + node.a);
    } else {
      tangents[id] = tangent(c, id, [&](NodeId operand) { return tangents[operand]; });
    }
  }
  for (const Partial& partial : gradient) {
    const NodeId node = tangents[partial.node];
    if (node != c.zero) result.push_back({partial.column, partial.column, node});
  }
}

}  // namespace taut::detail
