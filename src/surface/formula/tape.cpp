#include "surface/formula/tape.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

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

/// Which operands of an instruction must lie in slots, and what code takes the others as constants.
struct Form {
  Code code;
  std::array<NodeId, 4> slots{kNoNode, kNoNode, kNoNode, kNoNode};  // for a, b, c, d
  double value = 0;
  double value2 = 0;
  double value3 = 1;
};

Form form_of(const Graph& graph, NodeId id) {
  const Node& node = graph[id];
  Form form{code_of(node.op)};
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
      form.slots[0] = right ? node.a : node.b;
      return form;
    };
    if (node.op == Op::add) return with_constant(Code::add_c);
    if (node.op == Op::multiply) return with_constant(Code::multiply_c);
    if (node.op == Op::divide) return with_constant(right ? Code::divide_c : Code::c_divide);
    if (node.op == Op::subtract && !right) return with_constant(Code::c_subtract);
  }
  form.slots[0] = node.a;
  if (count > 1) form.slots[1] = node.b;
  if (count > 2) form.slots[2] = node.c;
  return form;
}

std::optional<FirstOp> first_op(Code code) {
  switch (code) {
    case Code::multiply: return FirstOp::multiply;
    case Code::multiply_c: return FirstOp::multiply_c;
    case Code::square: return FirstOp::square;
    case Code::add: return FirstOp::add;
    case Code::add_c: return FirstOp::add_c;
    case Code::subtract: return FirstOp::subtract;
    default: return std::nullopt;
  }
}

/// The second operation of `form` when operand number `position` is the result of the first.
std::optional<SecondOp> second_op(const Form& form, std::size_t position) {
  switch (form.code) {
    case Code::add: return SecondOp::add;
    case Code::add_c: return SecondOp::add_c;
    case Code::multiply: return SecondOp::multiply;
    case Code::multiply_c: return SecondOp::multiply_c;
    case Code::subtract: return position == 0 ? SecondOp::minus : SecondOp::from;
    case Code::c_subtract: return SecondOp::from_c;
    case Code::square: return SecondOp::square;
    default: return std::nullopt;
  }
}

class Compiler {
 public:
  Compiler(const Graph& graph, const std::vector<InputArray>& inputs, const std::vector<std::uint32_t>& output_sizes,
           const std::vector<Output>& outputs, bool fuse)
      : graph_(graph),
        inputs_(inputs),
        output_sizes_(output_sizes),
        outputs_(outputs),
        fuse_(fuse),
        read_(inputs.size()) {}

  Tape compile();

 private:
  [[nodiscard]] bool in_row(const Output& output) const { return output_sizes_[output.array] <= kMaxOutputRow; }
  void find_uses();
  void choose_fusions();
  [[nodiscard]] bool fuses(const Form& outer, std::size_t position) const;
  [[nodiscard]] Form form(NodeId id) const;
  void emit(NodeId id);
  void emit_input(NodeId id);
  void emit_outputs(NodeId id);
  void emit_rows();
  std::uint32_t slot_of(NodeId id);
  std::uint32_t acquire();
  void release(NodeId id);

  static constexpr std::uint32_t kNoSlot = ~std::uint32_t{0};

  const Graph& graph_;
  const std::vector<InputArray>& inputs_;
  const std::vector<std::uint32_t>& output_sizes_;
  const std::vector<Output>& outputs_;
  const bool fuse_;
  Tape tape_;
  std::vector<NodeId> order_;
  std::vector<std::uint32_t> uses_;  // readers of a node's slot still to come
  std::vector<NodeId> inner_;        // the operand computed in the same instruction, or kNoNode
  std::vector<int> num_inner_;       // operations of the instruction before this one
  std::vector<bool> absorbed_;       // computed inside of its only user's instruction
  std::vector<std::uint32_t> slot_;
  std::vector<std::uint32_t> free_;
  std::vector<bool> read_;                                        // input arrays that were read as rows
  std::vector<std::vector<NodeId>> row_nodes_;                    // by input array: the variables in it, by entry
  std::vector<std::pair<NodeId, std::uint32_t>> single_outputs_;  // by node: outputs written as soon as they are known
};

void Compiler::find_uses() {
  std::vector<NodeId> roots;
  for (std::uint32_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = outputs_[i];
    if (!in_row(output) && graph_.is_constant(output.node)) continue;
    roots.push_back(output.node);
    if (!in_row(output)) single_outputs_.emplace_back(output.node, i);
  }
  std::sort(single_outputs_.begin(), single_outputs_.end());
  order_ = graph_.reachable(roots);
  uses_.assign(order_.empty() ? 0 : order_.back() + std::size_t{1}, 0);
  slot_.assign(uses_.size(), kNoSlot);
  for (const NodeId root : roots) ++uses_[root];
  row_nodes_.resize(inputs_.size());
  for (const NodeId id : order_) {
    const Form form = form_of(graph_, id);
    for (const NodeId operand : form.slots) {
      if (operand != kNoNode) ++uses_[operand];
    }
    if (form.code != Code::input) continue;
    for (std::size_t array = 0; array < inputs_.size(); ++array) {
      const std::uint32_t entry = graph_[id].a - inputs_[array].first;
      if (entry >= inputs_[array].size || inputs_[array].size > kMaxInputRow) continue;
      row_nodes_[array].resize(inputs_[array].size, kNoNode);
      row_nodes_[array][entry] = id;
    }
  }
}

/// Can operand number `position` be computed in the instruction of `outer`: two operations of the table, then, one by
/// one, the factors of a scaled pair.
bool Compiler::fuses(const Form& outer, std::size_t position) const {
  const NodeId operand = outer.slots[position];
  if (operand == kNoNode || uses_[operand] != 1) return false;
  switch (num_inner_[operand]) {
    case 0: return second_op(outer, position) && first_op(form_of(graph_, operand).code);
    case 1: return outer.code == Code::multiply;
    case 2: return outer.code == Code::multiply_c;
    default: return false;
  }
}

/// A node with one reader is computed in that reader's instruction, where there is a code for them.
void Compiler::choose_fusions() {
  inner_.assign(uses_.size(), kNoNode);
  num_inner_.assign(uses_.size(), 0);
  absorbed_.assign(uses_.size(), false);
  if (!fuse_) return;
  for (const NodeId id : order_) {
    const Form outer = form_of(graph_, id);
    for (std::size_t k = 0; k < outer.slots.size() && inner_[id] == kNoNode; ++k) {
      if (!fuses(outer, k)) continue;
      inner_[id] = outer.slots[k];
      num_inner_[id] = num_inner_[inner_[id]] + 1;
      absorbed_[inner_[id]] = true;
    }
  }
}

Form Compiler::form(NodeId id) const {
  const Form outer = form_of(graph_, id);
  if (num_inner_[id] == 0) return outer;
  const std::size_t position = outer.slots[0] == inner_[id] ? 0 : 1;
  const NodeId other = outer.slots[1 - position];
  Form fused = form(inner_[id]);
  switch (num_inner_[id]) {
    case 1:
      fused.code = fused_code(*first_op(fused.code), *second_op(outer, position));
      fused.slots[2] = other;
      fused.value2 = outer.value;
      break;
    case 2:
      fused.code = scaled_code(fused.code);
      fused.slots[3] = other;
      break;
    default: fused.value3 = outer.value;
  }
  return fused;
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

/// Constants get their slot when it is first needed.
std::uint32_t Compiler::slot_of(NodeId id) {
  if (slot_[id] == kNoSlot) {
    slot_[id] = acquire();
    tape_.instructions.push_back({.code = Code::constant, .dst = slot_[id], .value = graph_[id].value});
  }
  return slot_[id];
}

void Compiler::emit_input(NodeId id) {
  std::uint32_t array = 0;
  while (graph_[id].a - inputs_[array].first >= inputs_[array].size) ++array;
  const std::uint32_t size = inputs_[array].size;
  if (size > kMaxInputRow) {
    slot_[id] = acquire();
    tape_.instructions.push_back(
        {.code = Code::input, .dst = slot_[id], .a = array, .b = graph_[id].a - inputs_[array].first});
    return;
  }
  if (read_[array]) return;
  read_[array] = true;
  const auto first = static_cast<std::uint32_t>(tape_.row_slots.size());
  tape_.instructions.push_back({.code = Code::input_row, .a = array, .b = first, .c = size});
  std::vector<std::uint32_t> unused;
  for (const NodeId node : row_nodes_[array]) {
    tape_.row_slots.push_back(acquire());
    if (node == kNoNode) {
      unused.push_back(tape_.row_slots.back());
    } else {
      slot_[node] = tape_.row_slots.back();
    }
  }
  free_.insert(free_.end(), unused.begin(), unused.end());
}

void Compiler::emit(NodeId id) {
  const Form what = form(id);
  if (what.code == Code::input) {
    emit_input(id);
    return;
  }
  Instruction instruction{.code = what.code, .value = what.value, .value2 = what.value2, .value3 = what.value3};
  if (what.code == Code::odd_power) instruction.b = graph_[id].b;
  std::uint32_t* const slots[] = {&instruction.a, &instruction.b, &instruction.c, &instruction.d};
  for (std::size_t k = 0; k < what.slots.size(); ++k) {
    if (what.slots[k] != kNoNode) *slots[k] = slot_of(what.slots[k]);
  }
  // Lanes are read before they are written, so a result may take the slot of an operand that ends here.
  for (const NodeId operand : what.slots) {
    if (operand != kNoNode) release(operand);
  }
  instruction.dst = slot_[id] = acquire();
  tape_.instructions.push_back(instruction);
}

void Compiler::emit_outputs(NodeId id) {
  for (auto at = std::lower_bound(single_outputs_.begin(), single_outputs_.end(), std::pair{id, std::uint32_t{0}});
       at != single_outputs_.end() && at->first == id; ++at) {
    const Output& output = outputs_[at->second];
    tape_.instructions.push_back({.code = Code::output, .a = slot_[id], .b = output.entry, .c = output.array});
    release(id);
  }
}

void Compiler::emit_rows() {
  for (std::uint32_t array = 0; array < output_sizes_.size(); ++array) {
    std::vector<NodeId> row;
    for (const Output& output : outputs_) {
      if (output.array != array || !in_row(output)) continue;
      row.resize(output_sizes_[array]);
      row[output.entry] = output.node;
    }
    if (row.empty()) continue;
    const Instruction instruction{.code = Code::output_row,
                                  .a = static_cast<std::uint32_t>(row.size()),
                                  .b = static_cast<std::uint32_t>(tape_.row_slots.size()),
                                  .c = array};
    for (const NodeId node : row) tape_.row_slots.push_back(slot_of(node));
    tape_.instructions.push_back(instruction);
  }
}

Tape Compiler::compile() {
  find_uses();
  choose_fusions();
  for (const Output& output : outputs_) {
    if (in_row(output) || !graph_.is_constant(output.node)) continue;
    tape_.instructions.push_back(
        {.code = Code::output_constant, .b = output.entry, .c = output.array, .value = graph_[output.node].value});
  }
  for (const NodeId id : order_) {
    if (graph_.is_constant(id) || absorbed_[id]) continue;
    emit(id);
    emit_outputs(id);
  }
  emit_rows();
  return std::move(tape_);
}

}  // namespace

Tape compile(const Graph& graph, const std::vector<InputArray>& inputs, const std::vector<std::uint32_t>& output_sizes,
             const std::vector<Output>& outputs, bool fuse) {
  return Compiler(graph, inputs, output_sizes, outputs, fuse).compile();
}

}  // namespace taut::detail
