#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// What a node of the expression graph computes from its operands a, b, c.
enum class Op : std::uint8_t {
  constant,  // value
  variable,  // input number a
  // one operand
  negate,
  absolute,
  sign,
  square,
  odd_power,  // a^n, n = b odd, 3 <= n <= kMaxOddPower: the tape multiplies, intervals use monotonicity
  sqrt,
  cbrt,
  exp,
  log,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  // two operands
  add,
  subtract,
  multiply,
  divide,
  minimum,
  maximum,
  power,
  atan2,
  // only in derivatives: masks (all bits set or none) and what they choose
  less_equal,  // a <= b, a mask
  choose,      // mask a ? b : c
  keep,        // mask a ? b : 0
  drop,        // mask a ? 0 : b
};

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = ~NodeId{0};
inline constexpr std::uint32_t kMaxOddPower = 255;

struct Node {
  Op op = Op::constant;
  NodeId a = kNoNode;
  NodeId b = kNoNode;
  NodeId c = kNoNode;
  double value = 0;
};

/// How many of a, b, c name other nodes.
[[nodiscard]] int operand_count(Op op);

/// The value of an operation on constants, with the same conventions at kinks and poles as the tape.
[[nodiscard]] double fold(Op op, double a, double b, std::uint32_t odd_exponent);

/// Expressions that share their parts. Every node is stored once and after its operands, so node order is an order of
/// evaluation and nothing here recurses, however deep a formula is.
///
/// The constructors simplify, but only where IEEE arithmetic gives the same number (up to the sign of zero, and as long
/// as scaling by a power of two neither over- nor underflows): constants are folded, x*x becomes a square, integer
/// powers become squares and odd powers, signs and powers of two move outwards so that more parts are shared. 0 * x
/// stays, since x may be infinite.
class Graph {
 public:
  /// From now on constants are folded only where that does not round. A formula means what its folded constants say;
  /// its derivatives, to bound slopes by, must be those of exactly that function.
  void fold_exactly() { exact_ = true; }

  [[nodiscard]] const Node& operator[](NodeId id) const { return nodes_[id]; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  [[nodiscard]] bool is_constant(NodeId id) const { return nodes_[id].op == Op::constant; }
  [[nodiscard]] bool is_constant(NodeId id, double value) const { return is_constant(id) && nodes_[id].value == value; }

  NodeId constant(double value);
  NodeId variable(std::uint32_t index);

  NodeId negate(NodeId a);
  NodeId square(NodeId a);
  NodeId unary(Op op, NodeId a);
  NodeId add(NodeId a, NodeId b);
  NodeId subtract(NodeId a, NodeId b);
  NodeId multiply(NodeId a, NodeId b);
  NodeId divide(NodeId a, NodeId b);
  NodeId power(NodeId a, NodeId b);
  NodeId binary(Op op, NodeId a, NodeId b);

  NodeId less_equal(NodeId a, NodeId b) { return intern({Op::less_equal, a, b, kNoNode, 0}); }
  NodeId choose(NodeId mask, NodeId if_true, NodeId if_false);

  /// The sum of `terms`: in reading order when short, balanced when long (less rounding error, and a term lies only
  /// log n operations below the sum). Overwrites `terms`.
  NodeId sum(std::vector<NodeId>& terms, std::size_t first = 0);

  /// All nodes the roots depend on, themselves included, in evaluation order.
  [[nodiscard]] std::vector<NodeId> reachable(const std::vector<NodeId>& roots) const;

 private:
  NodeId intern(const Node& node);
  NodeId integer_power(NodeId a, std::uint64_t n);
  void grow_table();
  /// May an operation on these constants be folded?
  [[nodiscard]] bool folds(Op op, double a, double b = 0) const;

  std::vector<Node> nodes_;
  bool exact_ = false;
  std::vector<NodeId> table_;  // open addressing, power-of-two size
};

}  // namespace taut::detail
