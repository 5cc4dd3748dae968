#include "surface/formula/program.hpp"

#include <algorithm>
#include <utility>

namespace taut::detail {
namespace {

/// A Hessian of more operations than this is not compiled but taken column by column.
constexpr std::size_t kMaxHessianNodes = 200'000;
/// Forward mode is tried where it can win: few variables, not a huge formula.
constexpr Index kMaxForwardDim = 4;
constexpr std::size_t kMaxForwardNodes = 20'000;

std::vector<NodeId> nodes_of(const std::vector<Partial>& partials) {
  std::vector<NodeId> nodes;
  nodes.reserve(partials.size());
  for (const Partial& partial : partials) nodes.push_back(partial.node);
  return nodes;
}

}  // namespace

FormulaProgram::FormulaProgram(Graph graph, std::vector<NodeId> components, Index dim)
    : dim_(dim), components_(std::move(components)), graph_(std::move(graph)) {
  graph_.fold_exactly();
  value_shows_nan_ = find_nan();
  for (std::size_t id = 0; id < graph_.size(); ++id) {
    const Op op = graph_[static_cast<NodeId>(id)].op;
    has_kinks_ = has_kinks_ || op == Op::minimum || op == Op::maximum || op == Op::absolute || op == Op::sign;
  }
}

/// All operations but powers (NaN^0 = 1) pass a NaN on, so that it reaches the component that reads it.
bool FormulaProgram::find_nan() const {
  std::vector<bool> passes(graph_.size());
  for (const NodeId component : components_) passes[component] = true;
  Index variables = 0;
  for (std::size_t id = graph_.size(); id-- > 0;) {
    const Node& node = graph_[static_cast<NodeId>(id)];
    if (!passes[id] || node.op == Op::power) continue;
    if (node.op == Op::variable) ++variables;
    const NodeId operands[3] = {node.a, node.b, node.c};
    for (int i = 0; i < operand_count(node.op); ++i) passes[operands[i]] = true;
  }
  return variables == dim_;
}

std::vector<InputArray> FormulaProgram::inputs() const {
  const auto d = static_cast<std::uint32_t>(dim_);
  const auto k = static_cast<std::uint32_t>(codim());
  return {{0, d}, {d, k}, {d + k, d}};
}

NodeId FormulaProgram::weighted(NodeId node) const {
  return codim() == 1 ? graph_.multiply(node, graph_.variable(static_cast<std::uint32_t>(dim_))) : node;
}

void FormulaProgram::differentiate() const {
  if (differentiated_) return;
  const auto d = static_cast<std::uint32_t>(dim_);
  const auto k = static_cast<std::uint32_t>(codim());
  for (std::uint32_t i = 0; i < k; ++i) append_gradient(graph_, components_[i], d, i, jacobian_);
  if (dim_ <= kMaxForwardDim && graph_.size() < kMaxForwardNodes) {
    std::vector<Partial> forward;
    for (std::uint32_t i = 0; i < k; ++i) append_gradient_forward(graph_, components_[i], d, i, forward);
    const auto cost = [&](const std::vector<Partial>& partials) {
      std::vector<NodeId> roots = nodes_of(partials);
      roots.insert(roots.end(), components_.begin(), components_.end());
      return graph_.reachable(roots).size();
    };
    if (cost(forward) < cost(jacobian_)) jacobian_ = std::move(forward);
  }
  if (k == 1) {
    gradient_ = jacobian_;
  } else {
    std::vector<NodeId> terms;
    for (std::uint32_t i = 0; i < k; ++i) terms.push_back(graph_.multiply(components_[i], graph_.variable(d + i)));
    append_gradient(graph_, graph_.sum(terms), d, 0, gradient_);
  }
  differentiated_ = true;
}

Tape FormulaProgram::compile_outputs(bool with_jacobian, const std::vector<Partial>* hessian) const {
  const auto d = static_cast<std::uint32_t>(dim_);
  std::vector<Output> outputs;
  for (std::uint32_t i = 0; i < components_.size(); ++i) outputs.push_back({0, i, components_[i]});
  if (with_jacobian) {
    for (const Partial& partial : jacobian_) outputs.push_back({1, partial.row * d + partial.column, partial.node});
  }
  if (hessian != nullptr) {
    for (const Partial& partial : *hessian) {
      const NodeId node = weighted(partial.node);
      outputs.push_back({2, partial.column * d + partial.row, node});
      if (partial.row != partial.column) outputs.push_back({2, partial.row * d + partial.column, node});
    }
  }
  const auto k = static_cast<std::uint32_t>(codim());
  return compile_rows({k, with_jacobian ? k * d : 0, hessian != nullptr ? d * d : 0}, std::move(outputs));
}

/// Adds the zeros of arrays that are written a whole row at a time. Arrays of size 0 are not asked for.
Tape FormulaProgram::compile_rows(const std::vector<std::uint32_t>& sizes, std::vector<Output> outputs,
                                  bool fuse) const {
  for (std::uint32_t array = 0; array < sizes.size(); ++array) {
    if (sizes[array] > kMaxOutputRow) continue;
    std::vector<bool> named(sizes[array]);
    for (const Output& output : outputs) {
      if (output.array == array) named[output.entry] = true;
    }
    for (std::uint32_t entry = 0; entry < named.size(); ++entry) {
      if (!named[entry]) outputs.push_back({array, entry, graph_.constant(0)});
    }
  }
  return compile(graph_, inputs(), sizes, outputs, fuse);
}

const Tape& FormulaProgram::value() const {
  const std::scoped_lock lock(mutex_);
  if (!value_tape_) value_tape_ = compile_outputs(false, nullptr);
  return *value_tape_;
}

const Tape& FormulaProgram::bounds() const {
  const std::scoped_lock lock(mutex_);
  if (!bounds_tape_) {
    std::vector<Output> outputs;
    for (std::uint32_t i = 0; i < components_.size(); ++i) outputs.push_back({0, i, components_[i]});
    bounds_tape_ = compile_rows({static_cast<std::uint32_t>(codim()), 0, 0}, std::move(outputs), false);
  }
  return *bounds_tape_;
}

/// Interval arithmetic finds the range of an expression that reads every variable once (Moore 1966): all its operations
/// are continuous and exact by themselves. And where one jumps, a derivative says nothing.
bool FormulaProgram::derivatives_tighten() const {
  bool reads_twice = false;
  for (const NodeId component : components_) {
    std::vector<bool> read(graph_.size());
    for (const NodeId id : graph_.reachable({component})) {
      const Node& node = graph_[id];
      if (node.op == Op::sign || node.op == Op::atan2) return false;
      const NodeId operands[3] = {node.a, node.b, node.c};
      for (int i = 0; i < operand_count(node.op); ++i) {
        if (graph_.is_constant(operands[i])) continue;
        reads_twice = reads_twice || read[operands[i]];
        read[operands[i]] = true;
      }
    }
  }
  return reads_twice;
}

const Tape* FormulaProgram::jacobian_bounds() const {
  const std::scoped_lock lock(mutex_);
  if (!jacobian_bounds_tape_) {
    if (!derivatives_tighten()) return nullptr;
    differentiate();
    const auto d = static_cast<std::uint32_t>(dim_);
    std::vector<Output> outputs;
    for (const Partial& partial : jacobian_) outputs.push_back({1, partial.row * d + partial.column, partial.node});
    jacobian_bounds_tape_ = compile_rows({0, static_cast<std::uint32_t>(codim()) * d, 0}, std::move(outputs), false);
  }
  return &*jacobian_bounds_tape_;
}

const Tape& FormulaProgram::jacobian() const {
  const std::scoped_lock lock(mutex_);
  if (!jacobian_tape_) {
    differentiate();
    jacobian_tape_ = compile_outputs(true, nullptr);
  }
  return *jacobian_tape_;
}

const Tape* FormulaProgram::hessian() const {
  const std::scoped_lock lock(mutex_);
  if (hessian_too_large_) return nullptr;
  if (!hessian_tape_) {
    differentiate();
    std::vector<Partial> hessian;
    if (!append_hessian(graph_, gradient_, kMaxHessianNodes, hessian)) {
      hessian_too_large_ = true;
      return nullptr;
    }
    hessian_tape_ = compile_outputs(true, &hessian);
  }
  return &*hessian_tape_;
}

const Tape& FormulaProgram::hessian_times() const {
  const std::scoped_lock lock(mutex_);
  if (!hessian_times_tape_) {
    differentiate();
    const auto d = static_cast<std::uint32_t>(dim_);
    const auto k = static_cast<std::uint32_t>(codim());
    std::vector<Partial> product;
    append_directional(graph_, gradient_, d, d + k, product);
    std::vector<Output> outputs;
    for (std::uint32_t i = 0; i < k; ++i) outputs.push_back({0, i, components_[i]});
    for (const Partial& partial : product) outputs.push_back({2, partial.row, weighted(partial.node)});
    hessian_times_tape_ = compile_rows({k, 0, d}, std::move(outputs));
  }
  return *hessian_times_tape_;
}

}  // namespace taut::detail
