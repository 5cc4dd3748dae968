#include "surface/formula/expression.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "surface/formula/scalar_math.hpp"

namespace taut::detail {
namespace {

/// Integer powers up to this are multiplications; larger ones call pow.
constexpr double kMaxMultipliedPower = kMaxOddPower + 1;
/// Sums of at least this many terms are balanced.
constexpr std::size_t kLongSum = 16;

bool is_power_of_two(double c) {
  int exponent = 0;
  return std::isfinite(c) && std::abs(std::frexp(c, &exponent)) == 0.5 && std::abs(exponent) < 500;
}

double sign_of(double a) { return a > 0 ? 1 : a < 0 ? -1 : a; }

double odd_power(double a, std::uint32_t n) {
  double result = a;
  for (double square = a * a; n >>= 1; square *= square) {
    if (n & 1) result *= square;
  }
  return result;
}

/// Is the operation on doubles free of rounding?
bool is_exact(Op op, double a, double b) {
  constexpr double kNoUnderflow = 0x1p-960;  // products at least this large have an error that is a double, too
  const auto product = [&](double c, double d) {
    const double p = c * d;
    return c == 0 || d == 0 || (std::abs(p) > kNoUnderflow && std::fma(c, d, -p) == 0);
  };
  switch (op) {
    case Op::negate:
    case Op::absolute:
    case Op::sign:
    case Op::minimum:
    case Op::maximum: return true;
    case Op::square: return product(a, a);
    case Op::multiply: return product(a, b);
    case Op::divide: return a == 0 || (std::abs(a) > kNoUnderflow && std::fma(a / b, b, -a) == 0);
    case Op::add: {  // Knuth's exact error of a sum
      const double sum = a + b;
      const double part = sum - a;
      return (a - (sum - part)) + (b - part) == 0;
    }
    default: return false;
  }
}

double with_nan(double a, double b, double value) { return std::isnan(a) || std::isnan(b) ? a + b : value; }

}  // namespace

int operand_count(Op op) {
  if (op <= Op::variable) return 0;
  if (op <= Op::tanh) return 1;
  return op == Op::choose ? 3 : 2;
}

double fold(Op op, double a, double b, std::uint32_t odd_exponent) {
  switch (op) {
    case Op::negate: return -a;
    case Op::absolute: return std::abs(a);
    case Op::sign: return sign_of(a);
    case Op::square: return a * a;
    case Op::odd_power: return odd_power(a, odd_exponent);
    case Op::sqrt: return std::sqrt(a);
    case Op::cbrt: return std::cbrt(a);
    case Op::exp: return std::exp(a);
    case Op::log: return std::log(a);
    case Op::sin: return std::sin(a);
    case Op::cos: return std::cos(a);
    case Op::tan: return std::tan(a);
    case Op::asin: return std::asin(a);
    case Op::acos: return std::acos(a);
    case Op::atan: return std::atan(a);
    case Op::sinh: return std::sinh(a);
    case Op::cosh: return std::cosh(a);
    case Op::tanh: return std::tanh(a);
    case Op::add: return a + b;
    case Op::subtract: return a - b;
    case Op::multiply: return a * b;
    case Op::divide: return a / b;
    case Op::minimum: return with_nan(a, b, a <= b ? a : b);
    case Op::maximum: return with_nan(a, b, a >= b ? a : b);
    case Op::power: return power_of(a, b);
    case Op::atan2: return std::atan2(a, b);
    default: return std::numeric_limits<double>::quiet_NaN();
  }
}

bool Graph::folds(Op op, double a, double b) const { return !exact_ || is_exact(op, a, b); }

NodeId Graph::intern(const Node& node) {
  if (2 * (nodes_.size() + 1) > table_.size()) grow_table();
  const auto hash = [](const Node& n) {
    std::uint64_t h = std::bit_cast<std::uint64_t>(n.value);
    for (const std::uint64_t part : {std::uint64_t(n.op), std::uint64_t(n.a), std::uint64_t(n.b), std::uint64_t(n.c)}) {
      h = (h ^ part) * 0x9E3779B97F4A7C15u;
      h ^= h >> 29;
    }
    return h;
  };
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash(node) & mask;
  while (table_[slot] != kNoNode) {
    const Node& other = nodes_[table_[slot]];
    if (other.op == node.op && other.a == node.a && other.b == node.b && other.c == node.c &&
        std::bit_cast<std::uint64_t>(other.value) == std::bit_cast<std::uint64_t>(node.value)) {
      return table_[slot];
    }
    slot = (slot + 1) & mask;
  }
  table_[slot] = static_cast<NodeId>(nodes_.size());
  nodes_.push_back(node);
  return table_[slot];
}

void Graph::grow_table() {
  std::vector<Node> nodes = std::move(nodes_);
  nodes_.clear();
  nodes_.reserve(2 * nodes.size() + 32);
  table_.assign(std::max<std::size_t>(64, 4 * std::bit_ceil(nodes.size())), kNoNode);
  for (const Node& node : nodes) intern(node);
}

NodeId Graph::constant(double value) {
  return intern({Op::constant, kNoNode, kNoNode, kNoNode, value == 0 ? 0.0 : value});
}

NodeId Graph::variable(std::uint32_t index) { return intern({Op::variable, index, kNoNode, kNoNode, 0}); }

NodeId Graph::negate(NodeId a) {
  const Node node = nodes_[a];
  switch (node.op) {
    case Op::constant: return constant(-node.value);
    case Op::negate: return node.a;
    case Op::subtract: return subtract(node.b, node.a);
    case Op::multiply:
      if (is_constant(node.b)) return multiply(node.a, constant(-nodes_[node.b].value));
      break;
    default: break;
  }
  return intern({Op::negate, a, kNoNode, kNoNode, 0});
}

NodeId Graph::square(NodeId a) {
  const Node node = nodes_[a];
  switch (node.op) {
    case Op::constant:
      if (folds(Op::square, node.value)) return constant(node.value * node.value);
      break;
    case Op::negate:
    case Op::absolute: return square(node.a);
    default: break;
  }
  return intern({Op::square, a, kNoNode, kNoNode, 0});
}

NodeId Graph::unary(Op op, NodeId a) {
  const Node node = nodes_[a];
  if (op == Op::negate) return negate(a);
  if (op == Op::square) return square(a);
  if (node.op == Op::constant && folds(op, node.value)) return constant(fold(op, node.value, 0, 0));
  if (op == Op::absolute) {
    if (node.op == Op::absolute || node.op == Op::square || node.op == Op::sqrt || node.op == Op::exp) return a;
    if (node.op == Op::negate) return unary(op, node.a);
  }
  if ((op == Op::cos || op == Op::cosh) && (node.op == Op::negate || node.op == Op::absolute)) return unary(op, node.a);
  return intern({op, a, kNoNode, kNoNode, 0});
}

NodeId Graph::add(NodeId a, NodeId b) {
  if (is_constant(a)) std::swap(a, b);
  const Node left = nodes_[a];
  const Node right = nodes_[b];
  if (right.op == Op::constant) {
    if (left.op == Op::constant && folds(Op::add, left.value, right.value)) return constant(left.value + right.value);
    if (right.value == 0) return a;
    return intern({Op::add, a, b, kNoNode, 0});
  }
  if (a == b) return multiply(a, constant(2));
  if (right.op == Op::negate) return subtract(a, right.a);
  if (left.op == Op::negate) return subtract(b, left.a);
  return intern({Op::add, std::min(a, b), std::max(a, b), kNoNode, 0});
}

NodeId Graph::subtract(NodeId a, NodeId b) {
  const Node left = nodes_[a];
  const Node right = nodes_[b];
  if (right.op == Op::constant) return add(a, constant(-right.value));
  if (left.op == Op::constant && left.value == 0) return negate(b);
  if (right.op == Op::negate) return add(a, right.a);
  return intern({Op::subtract, a, b, kNoNode, 0});
}

NodeId Graph::multiply(NodeId a, NodeId b) {
  if (is_constant(a)) std::swap(a, b);
  const Node left = nodes_[a];
  const Node right = nodes_[b];
  if (right.op == Op::constant) {
    const double c = right.value;
    if (left.op == Op::constant && folds(Op::multiply, left.value, c)) return constant(left.value * c);
    if (c == 1) return a;
    if (c == -1) return negate(a);
    if (left.op == Op::negate) return multiply(left.a, constant(-c));
    if (left.op == Op::multiply && is_constant(left.b)) {
      const double inner = nodes_[left.b].value;
      if ((is_power_of_two(c) || is_power_of_two(inner)) && std::isnormal(c * inner)) {
        return multiply(left.a, constant(c * inner));
      }
    }
    return intern({Op::multiply, a, b, kNoNode, 0});
  }
  if (a == b) return square(a);
  if (left.op == Op::negate) return negate(multiply(left.a, b));
  if (right.op == Op::negate) return negate(multiply(a, right.a));
  if (left.op == Op::multiply && is_constant(left.b) && is_power_of_two(nodes_[left.b].value)) {
    return multiply(multiply(left.a, b), left.b);
  }
  if (right.op == Op::multiply && is_constant(right.b) && is_power_of_two(nodes_[right.b].value)) {
    return multiply(multiply(a, right.a), right.b);
  }
  return intern({Op::multiply, std::min(a, b), std::max(a, b), kNoNode, 0});
}

NodeId Graph::divide(NodeId a, NodeId b) {
  const Node left = nodes_[a];
  const Node right = nodes_[b];
  if (right.op == Op::constant) {
    if (left.op == Op::constant && folds(Op::divide, left.value, right.value)) {
      return constant(left.value / right.value);
    }
    if (is_power_of_two(right.value)) return multiply(a, constant(1 / right.value));
  }
  if (left.op == Op::negate) return negate(divide(left.a, b));
  if (right.op == Op::negate) return negate(divide(a, right.a));
  return intern({Op::divide, a, b, kNoNode, 0});
}

NodeId Graph::integer_power(NodeId a, std::uint64_t n) {
  if (n == 0) return constant(1);
  if (n == 1) return a;
  if (n % 2 == 0) return square(integer_power(a, n / 2));
  const Node node = nodes_[a];
  if (node.op == Op::negate) return negate(integer_power(node.a, n));
  if (node.op == Op::constant && !exact_) return constant(odd_power(node.value, static_cast<std::uint32_t>(n)));
  return intern({Op::odd_power, a, static_cast<NodeId>(n), kNoNode, 0});
}

NodeId Graph::power(NodeId a, NodeId b) {
  const Node base = nodes_[a];
  const Node exponent = nodes_[b];
  if (exponent.op != Op::constant) {
    return intern({Op::power, a, b, kNoNode, 0});
  }
  const double e = exponent.value;
  if (base.op == Op::constant && !exact_) return constant(fold(Op::power, base.value, e, 0));
  const double size = std::abs(e);
  if (size <= kMaxMultipliedPower && 2 * size == std::floor(2 * size)) {
    const auto whole = static_cast<std::uint64_t>(size);
    NodeId result = integer_power(a, whole);
    if (size != std::floor(size)) result = whole == 0 ? unary(Op::sqrt, a) : multiply(result, unary(Op::sqrt, a));
    return e < 0 ? divide(constant(1), result) : result;
  }
  return intern({Op::power, a, b, kNoNode, 0});
}

NodeId Graph::binary(Op op, NodeId a, NodeId b) {
  switch (op) {
    case Op::add: return add(a, b);
    case Op::subtract: return subtract(a, b);
    case Op::multiply: return multiply(a, b);
    case Op::divide: return divide(a, b);
    case Op::power: return power(a, b);
    default: break;
  }
  if (is_constant(a) && is_constant(b) && folds(op, nodes_[a].value, nodes_[b].value)) {
    return constant(fold(op, nodes_[a].value, nodes_[b].value, 0));
  }
  if (a == b && (op == Op::minimum || op == Op::maximum)) return a;
  return intern({op, a, b, kNoNode, 0});
}

NodeId Graph::choose(NodeId mask, NodeId if_true, NodeId if_false) {
  if (if_true == if_false) return if_true;
  if (is_constant(if_false, 0)) return intern({Op::keep, mask, if_true, kNoNode, 0});
  if (is_constant(if_true, 0)) return intern({Op::drop, mask, if_false, kNoNode, 0});
  return intern({Op::choose, mask, if_true, if_false, 0});
}

NodeId Graph::sum(std::vector<NodeId>& terms, std::size_t first) {
  std::size_t count = terms.size() - first;
  if (count == 0) return constant(0);
  const std::size_t run = count < kLongSum ? count : kLongSum / 2;
  while (count > 1) {
    const std::size_t step = count < kLongSum ? count : run;
    std::size_t kept = 0;
    for (std::size_t begin = 0; begin < count; begin += step) {
      const std::size_t end = std::min(count, begin + step);
      NodeId total = terms[first + begin];
      for (std::size_t i = begin + 1; i < end; ++i) total = add(total, terms[first + i]);
      terms[first + kept++] = total;
    }
    count = kept;
  }
  const NodeId result = terms[first];
  terms.resize(first);
  return result;
}

std::vector<NodeId> Graph::reachable(const std::vector<NodeId>& roots) const {
  std::vector<bool> seen;
  std::vector<NodeId> result;
  std::vector<NodeId> open;
  NodeId top = 0;
  for (const NodeId root : roots) top = std::max(top, root + 1);
  seen.resize(top);
  const auto visit = [&](NodeId id) {
    if (seen[id]) return;
    seen[id] = true;
    open.push_back(id);
  };
  for (const NodeId root : roots) visit(root);
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    result.push_back(id);
    const Node& node = nodes_[id];
    const int count = operand_count(node.op);
    if (count > 0) visit(node.a);
    if (count > 1) visit(node.b);
    if (count > 2) visit(node.c);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace taut::detail
