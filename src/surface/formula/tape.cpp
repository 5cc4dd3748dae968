#include "surface/formula/tape.hpp"

#include <algorithm>

namespace taut::detail {
namespace {

Code code_of(Op op) {
  switch (op) {
    case Op::negate: return Code::negate;
    case Op::absolute: return Code::absolute;
    case Op::sign: return Code::sign;
    case Op::square: return Code::square;
    case Op::odd_power: return Code::odd_power;
    case Op::sqrt: return Code::sqrt;
    case Op::cbrt: return Code::cbrt;
    case Op::exp: return Code::exp;
    case Op::log: return Code::log;
    case Op::sin: return Code::sin;
    case Op::cos: return Code::cos;
    case Op::tan: return Code::tan;
    case Op::asin: return Code::asin;
    case Op::acos: return Code::acos;
    case Op::atan: return Code::atan;
    case Op::sinh: return Code::sinh;
    case Op::cosh: return Code::cosh;
    case Op::tanh: return Code::tanh;
    case Op::add: return Code::add;
    case Op::subtract: return Code::subtract;
    case Op::multiply: return Code::multiply;
    case Op::divide: return Code::divide;
    case Op::minimum: return Code::minimum;
    case Op::maximum: return Code::maximum;
    case Op::power: return Code::power;
    case Op::atan2: return Code::atan2;
    case Op::less_equal: return Code::less_equal;
    case Op::choose: return Code::choose;
    case Op::keep: return Code::keep;
    case Op::drop: return Code::drop;
    default: return Code::constant;
  }
}

/// Which operands of a node must lie in slots, and what code takes the others as constants.
struct Form {
  Code code;
  NodeId slots[3] = {kNoNode, kNoNode, kNoNode};
  int num_slots = 0;
  double value = 0;
};

Form form_of(const Graph& graph, NodeId id) {
  const Node& node = graph[id];
  Form form{code_of(node.op)};
  const auto slot = [&](NodeId operand) { form.slots[form.num_slots++] = operand; };
  if (node.op == Op::constant) {
    form.value = node.value;
    return form;
  }
  if (node.op == Op::variable) {
    form.code = Code::input;
    return form;
  }
  const int count = operand_count(node.op);
  if (count == 2 && graph.is_constant(node.b) != graph.is_constant(node.a)) {
    const bool right = graph.is_constant(node.b);
    const double value = graph[right ? node.b : node.a].value;
    const auto with_constant = [&](Code code) {
      form.code = code;
      form.value = value;
      slot(right ? node.a : node.b);
      return form;
    };
    if (node.op == Op::add) return with_constant(Code::add_c);
    if (node.op == Op::multiply) return with_constant(Code::multiply_c);
    if (node.op == Op::divide) return with_constant(right ? Code::divide_c : Code::c_divide);
    if (node.op == Op::subtract && !right) return with_constant(Code::c_subtract);
  }
  slot(node.a);
  if (count > 1) slot(node.b);
  if (count > 2) slot(node.c);
  return form;
}

class Compiler {
 public:
  Compiler(const Graph& graph, const std::vector<InputArray>& inputs, const std::vector<Output>& outputs)
      : graph_(graph), inputs_(inputs), outputs_(outputs) {}

  Tape compile();

 private:
  void find_uses();
  void emit(NodeId id);
  void emit_outputs(NodeId id);
  void release(NodeId id);
  std::uint32_t acquire();

  const Graph& graph_;
  const std::vector<InputArray>& inputs_;
  const std::vector<Output>& outputs_;
  Tape tape_;
  std::vector<NodeId> order_;
  std::vector<std::uint32_t> uses_;  // instructions still to come that read a node's slot
  std::vector<std::uint32_t> slot_;
  std::vector<std::uint32_t> free_;
  std::vector<std::pair<NodeId, std::uint32_t>> outputs_by_node_;
};

void Compiler::find_uses() {
  std::vector<NodeId> roots;
  for (std::uint32_t i = 0; i < outputs_.size(); ++i) {
    if (graph_.is_constant(outputs_[i].node)) continue;
    roots.push_back(outputs_[i].node);
    outputs_by_node_.emplace_back(outputs_[i].node, i);
  }
  std::sort(outputs_by_node_.begin(), outputs_by_node_.end());
  order_ = graph_.reachable(roots);
  uses_.assign(order_.empty() ? 0 : order_.back() + std::size_t{1}, 0);
  slot_.resize(uses_.size());
  for (const NodeId root : roots) ++uses_[root];
  for (std::size_t i = order_.size(); i-- > 0;) {
    const Form form = form_of(graph_, order_[i]);
    for (int k = 0; k < form.num_slots; ++k) ++uses_[form.slots[k]];
  }
}

std::uint32_t Compiler::acquire() {
  if (free_.empty()) return tape_.num_slots++;
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  return slot;
}

void Compiler::release(NodeId id) {
  if (--uses_[id] == 0) free_.push_back(slot_[id]);
}

void Compiler::emit(NodeId id) {
  const Node& node = graph_[id];
  const Form form = form_of(graph_, id);
  Instruction instruction{.code = form.code, .value = form.value};
  if (form.code == Code::input) {
    std::uint32_t array = 0;
    while (node.a - inputs_[array].first >= inputs_[array].size) ++array;
    instruction.a = array;
    instruction.b = node.a - inputs_[array].first;
  }
  if (node.op == Op::odd_power) instruction.b = node.b;
  if (form.num_slots > 0) instruction.a = slot_[form.slots[0]];
  if (form.num_slots > 1) instruction.b = slot_[form.slots[1]];
  if (form.num_slots > 2) instruction.c = slot_[form.slots[2]];
  // Lanes are read before they are written, so a result may take the slot of an operand that ends here.
  for (int k = 0; k < form.num_slots; ++k) release(form.slots[k]);
  instruction.dst = slot_[id] = acquire();
  tape_.instructions.push_back(instruction);
}

void Compiler::emit_outputs(NodeId id) {
  for (auto at = std::lower_bound(outputs_by_node_.begin(), outputs_by_node_.end(), std::pair{id, std::uint32_t{0}});
       at != outputs_by_node_.end() && at->first == id; ++at) {
    const Output& output = outputs_[at->second];
    tape_.instructions.push_back({.code = Code::output, .a = slot_[id], .b = output.entry, .c = output.array});
    release(id);
  }
}

Tape Compiler::compile() {
  find_uses();
  for (const Output& output : outputs_) {
    if (!graph_.is_constant(output.node)) continue;
    tape_.instructions.push_back(
        {.code = Code::output_constant, .b = output.entry, .c = output.array, .value = graph_[output.node].value});
  }
  for (const NodeId id : order_) {
    if (uses_[id] == 0) continue;  // a constant that every user holds in its instruction
    emit(id);
    emit_outputs(id);
  }
  return std::move(tape_);
}

}  // namespace

Tape compile(const Graph& graph, const std::vector<InputArray>& inputs, const std::vector<Output>& outputs) {
  return Compiler(graph, inputs, outputs).compile();
}

}  // namespace taut::detail
