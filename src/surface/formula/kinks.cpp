// Finds the kinks of an expression graph and replaces each by one of its branches.
//
//   kink          condition c    c >= 0 takes    c <= 0 takes
//   max(a, b)     a - b          a               b
//   min(a, b)     b - a          a               b
//   abs(a)        a              a               -a
//   sign(a)       a              1               -1
//
// Nodes stand after their operands, so that one pass in node order rewrites a whole expression. The graph shares equal
// parts: two choices of sides that mean the same formula give the same node, and so the same face.
#include "surface/formula/kinks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "surface/formula/formula_function.hpp"

namespace taut::detail {
namespace {

bool is_kink(Op op) { return op == Op::minimum || op == Op::maximum || op == Op::absolute || op == Op::sign; }

std::string_view name_of(Op op) {
  switch (op) {
    case Op::sqrt: return "sqrt";
    case Op::cbrt: return "cbrt";
    case Op::exp: return "exp";
    case Op::log: return "log";
    case Op::sin: return "sin";
    case Op::cos: return "cos";
    case Op::tan: return "tan";
    case Op::asin: return "asin";
    case Op::acos: return "acos";
    case Op::atan: return "atan";
    case Op::sinh: return "sinh";
    case Op::cosh: return "cosh";
    case Op::tanh: return "tanh";
    case Op::absolute: return "abs";
    case Op::sign: return "sign";
    case Op::minimum: return "min";
    case Op::maximum: return "max";
    case Op::atan2: return "atan2";
    default: return "";
  }
}

/// The node with other operands, in a graph that may be another one.
template <class Image>
NodeId rebuilt(Graph& graph, const Node& node, const Image& of) {
  switch (node.op) {
    case Op::constant: return graph.constant(node.value);
    case Op::variable: return graph.variable(node.a);
    case Op::negate: return graph.negate(of(node.a));
    case Op::square: return graph.square(of(node.a));
    case Op::odd_power: return graph.power(of(node.a), graph.constant(node.b));
    case Op::add: return graph.add(of(node.a), of(node.b));
    case Op::subtract: return graph.subtract(of(node.a), of(node.b));
    case Op::multiply: return graph.multiply(of(node.a), of(node.b));
    case Op::divide: return graph.divide(of(node.a), of(node.b));
    case Op::power: return graph.power(of(node.a), of(node.b));
    default:
      return operand_count(node.op) == 1 ? graph.unary(node.op, of(node.a))
                                         : graph.binary(node.op, of(node.a), of(node.b));
  }
}

}  // namespace

std::unique_ptr<FormulaKinks> FormulaKinks::of(const ImplicitFunction& function, const ImplicitFunction* domain) {
  const auto* formula = dynamic_cast<const FormulaFunction*>(&function);
  const auto* cut = dynamic_cast<const FormulaFunction*>(domain);
  const bool kinked_domain = cut != nullptr && cut->program().has_kinks();
  if (!kinked_domain && (formula == nullptr || !formula->program().has_kinks())) return nullptr;
  Graph graph;
  std::vector<NodeId> components;
  if (formula != nullptr) std::tie(graph, components) = formula->program().expressions();
  std::vector<NodeId> bounds;
  const std::size_t num_of_formula = graph.size();
  if (kinked_domain) {
    const auto [other, roots] = cut->program().expressions();
    std::unordered_map<NodeId, NodeId> image;
    for (const NodeId id : other.reachable(roots)) {
      image[id] = rebuilt(graph, other[id], [&](NodeId operand) { return image.at(operand); });
    }
    for (const NodeId root : roots) bounds.push_back(image.at(root));
  }
  std::unique_ptr<FormulaKinks> kinks(
      new FormulaKinks(std::move(graph), std::move(components), std::move(bounds), num_of_formula, function.dim()));
  return kinks->num_kinks() > 0 ? std::move(kinks) : nullptr;
}

FormulaKinks::FormulaKinks(Graph graph, std::vector<NodeId> components, std::vector<NodeId> domain,
                           std::size_t num_of_formula, Index dim)
    : graph_(std::move(graph)),
      components_(std::move(components)),
      domain_(std::move(domain)),
      num_parsed_(graph_.size()),
      dim_(dim) {
  std::vector<NodeId> roots = components_;
  roots.insert(roots.end(), domain_.begin(), domain_.end());
  for (const NodeId id : graph_.reachable(roots)) {
    const Node node = graph_[id];
    if (!is_kink(node.op)) continue;
    NodeId condition = node.a;
    if (node.op == Op::maximum) condition = graph_.subtract(node.a, node.b);
    if (node.op == Op::minimum) condition = graph_.subtract(node.b, node.a);
    kinks_.push_back({id, condition});
    if (id < num_of_formula) ++first_in_domain_;
  }
}

std::shared_ptr<const ImplicitFunction> FormulaKinks::conditions() const {
  std::vector<NodeId> nodes;
  for (const Kink& kink : kinks_) nodes.push_back(kink.condition);
  return function(nodes);
}

std::shared_ptr<const ImplicitFunction> FormulaKinks::function(const std::vector<NodeId>& components) const {
  return std::make_shared<FormulaFunction>(std::make_shared<const FormulaProgram>(graph_, components, dim_));
}

NodeId FormulaKinks::smooth(NodeId root, const Sides& sides) {
  std::unordered_map<NodeId, NodeId> image;
  const auto of = [&](NodeId id) { return image.at(id); };
  for (const NodeId id : graph_.reachable({root})) {
    const Node node = graph_[id];
    const int operands = operand_count(node.op);
    NodeId result = id;
    if (is_kink(node.op)) {
      const auto kink =
          std::lower_bound(kinks_.begin(), kinks_.end(), id, [](const Kink& k, NodeId n) { return k.node < n; });
      const bool first = sides[static_cast<std::size_t>(kink - kinks_.begin())] > 0;
      if (node.op == Op::absolute) {
        result = first ? of(node.a) : graph_.negate(of(node.a));
      } else if (node.op == Op::sign) {
        result = graph_.constant(first ? 1 : -1);
      } else {
        result = first ? of(node.a) : of(node.b);
      }
    } else {
      const bool changed = operands > 0 && (of(node.a) != node.a || (operands > 1 && of(node.b) != node.b));
      if (changed) result = rebuilt(graph_, node, of);
    }
    image[id] = result;
  }
  return image.at(root);
}

std::vector<NodeId> FormulaKinks::face(const Sides& sides) {
  std::vector<NodeId> roots;
  for (const NodeId component : components_) roots.push_back(smooth(component, sides));
  return roots;
}

NodeId FormulaKinks::bound(Index component, const Sides& sides) {
  return smooth(domain_[static_cast<std::size_t>(component)], sides);
}

std::vector<int> FormulaKinks::taken(const Sides& sides) const {
  std::vector<bool> seen(num_parsed_);
  std::vector<NodeId> open = components_;
  open.insert(open.end(), domain_.begin(), domain_.end());
  std::vector<int> found;
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (seen[id]) continue;
    seen[id] = true;
    const Node& node = graph_[id];
    if (!is_kink(node.op)) {
      const NodeId operands[3] = {node.a, node.b, node.c};
      for (int i = 0; i < operand_count(node.op); ++i) open.push_back(operands[i]);
      continue;
    }
    const auto kink =
        std::lower_bound(kinks_.begin(), kinks_.end(), id, [](const Kink& k, NodeId n) { return k.node < n; });
    found.push_back(static_cast<int>(kink - kinks_.begin()));
    const bool second =
        (node.op == Op::minimum || node.op == Op::maximum) && sides[static_cast<std::size_t>(found.back())] < 0;
    if (node.op != Op::sign) open.push_back(second ? node.b : node.a);
  }
  return found;
}

std::vector<FormulaKinks::Sides> FormulaKinks::choices(const Sides& sides, const std::vector<int>& open) const {
  std::vector<Sides> found;
  std::vector<std::pair<Sides, std::vector<int>>> left{{sides, open}};
  while (!left.empty() && found.size() < kMostChoices) {
    auto [choice, undecided] = std::move(left.back());
    left.pop_back();
    const std::vector<int> kinks = taken(choice);
    const auto next = std::find_if(kinks.begin(), kinks.end(), [&](int kink) {
      return std::find(undecided.begin(), undecided.end(), kink) != undecided.end();
    });
    if (next == kinks.end()) {
      found.push_back(std::move(choice));
      continue;
    }
    std::erase(undecided, *next);
    left.emplace_back(choice, undecided);
    auto& side = choice[static_cast<std::size_t>(*next)];
    side = static_cast<std::int8_t>(-side);
    left.emplace_back(std::move(choice), std::move(undecided));
  }
  return found;
}

NodeId FormulaKinks::condition(Index kink, const Sides& sides) {
  return smooth(kinks_[static_cast<std::size_t>(kink)].condition, sides);
}

/// Brackets are set by rank: 0 sums, 1 products, 2 powers, 3 atoms.
std::string FormulaKinks::text(NodeId root) const {
  struct Piece {
    std::string text;
    int rank;
  };
  std::unordered_map<NodeId, Piece> image;
  const auto with_rank = [&](NodeId id, int rank) {
    const Piece& piece = image.at(id);
    return piece.rank < rank ? "(" + piece.text + ")" : piece.text;
  };
  static constexpr std::string_view kLetters = "xyzw";
  for (const NodeId id : graph_.reachable({root})) {
    const Node& node = graph_[id];
    Piece piece{"", 3};
    switch (node.op) {
      case Op::constant: piece = {fmt::format("{:.6g}", node.value), node.value < 0 ? 0 : 3}; break;
      case Op::variable:
        piece.text = dim_ <= 4 ? std::string(1, kLetters[node.a]) : fmt::format("x{}", node.a + 1);
        break;
      case Op::negate: piece = {fmt::format("-{}", with_rank(node.a, 1)), 0}; break;
      case Op::square: piece = {with_rank(node.a, 3) + "^2", 2}; break;
      case Op::odd_power: piece = {with_rank(node.a, 3) + fmt::format("^{}", node.b), 2}; break;
      case Op::add: {
        const std::string b = with_rank(node.b, 0);
        piece = {with_rank(node.a, 0) + (b.starts_with('-') ? "" : "+") + b, 0};
        break;
      }
      case Op::subtract: piece = {with_rank(node.a, 0) + "-" + with_rank(node.b, 1), 0}; break;
      case Op::multiply: piece = {with_rank(node.a, 1) + "*" + with_rank(node.b, 1), 1}; break;
      case Op::divide: piece = {with_rank(node.a, 1) + "/" + with_rank(node.b, 2), 1}; break;
      case Op::power: piece = {with_rank(node.a, 3) + "^" + with_rank(node.b, 3), 2}; break;
      default:
        piece.text = fmt::format("{}({}{})", name_of(node.op), image.at(node.a).text,
                                 operand_count(node.op) == 2 ? "," + image.at(node.b).text : "");
    }
    constexpr std::size_t kLongest = 200;
    if (piece.text.size() > kLongest) piece = {"...", 3};
    image[id] = std::move(piece);
  }
  return image.at(root).text;
}

}  // namespace taut::detail
