#pragma once

#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "surface/formula/derivative.hpp"
#include "surface/formula/expression.hpp"
#include "surface/formula/tape.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// The tapes of one function R^d -> R^k. Each is compiled when first asked for, then shared by all evaluators and
/// threads.
///
/// Input arrays: 0 x (d), 1 weight (k), 2 direction (d). Output arrays: 0 value (k), 1 Jacobian (k d), 2 Hessian (d d)
/// or Hessian times direction (d). Arrays of more than kMaxOutputRow entries are written only where they are not zero
/// whatever x is.
class FormulaProgram {
 public:
  FormulaProgram(Graph graph, std::vector<NodeId> components, Index dim);

  [[nodiscard]] Index dim() const { return dim_; }
  [[nodiscard]] Index codim() const { return static_cast<Index>(components_.size()); }
  /// May F have places where it is not smooth: minima, maxima, absolute values, signs.
  [[nodiscard]] bool has_kinks() const { return has_kinks_; }
  /// The graph so far and the components of F in it.
  [[nodiscard]] std::pair<Graph, std::vector<NodeId>> expressions() const {
    const std::scoped_lock lock(mutex_);
    return {graph_, components_};
  }
  /// Is some component NaN wherever a coordinate is.
  [[nodiscard]] bool value_shows_nan() const { return value_shows_nan_; }

  [[nodiscard]] const Tape& value() const;
  /// Value, for boxes.
  [[nodiscard]] const Tape& bounds() const;
  /// Jacobian, for boxes; null when it does not tell more about F than bounds() do.
  [[nodiscard]] const Tape* jacobian_bounds() const;
  /// Value and Jacobian.
  [[nodiscard]] const Tape& jacobian() const;
  /// Value, Jacobian and weighted Hessian; null when the Hessian is too large an expression (dense in many dimensions).
  [[nodiscard]] const Tape* hessian() const;
  /// Weighted Hessian times direction: linear in the size of the formula.
  [[nodiscard]] const Tape& hessian_times() const;

 private:
  void differentiate() const;
  [[nodiscard]] Tape compile_outputs(bool with_jacobian, const std::vector<Partial>* hessian) const;
  [[nodiscard]] Tape compile_rows(const std::vector<std::uint32_t>& sizes, std::vector<Output> outputs,
                                  bool fuse = true) const;
  [[nodiscard]] bool derivatives_tighten() const;
  [[nodiscard]] bool find_nan() const;
  [[nodiscard]] NodeId weighted(NodeId node) const;
  [[nodiscard]] std::vector<InputArray> inputs() const;

  Index dim_;
  std::vector<NodeId> components_;
  bool value_shows_nan_;
  bool has_kinks_ = false;

  // The graph grows under the mutex as derivatives are asked for. In which order they are does not show in any number:
  // a node's value depends on its operands alone.
  mutable std::mutex mutex_;
  mutable Graph graph_;
  mutable bool differentiated_ = false;
  mutable bool hessian_too_large_ = false;
  mutable std::vector<Partial> jacobian_;  // row: component
  mutable std::vector<Partial> gradient_;  // of sum_i weight_i F_i; when k = 1 of F, weighted at the end
  mutable std::optional<Tape> value_tape_;
  mutable std::optional<Tape> bounds_tape_;
  mutable std::optional<Tape> jacobian_bounds_tape_;
  mutable std::optional<Tape> jacobian_tape_;
  mutable std::optional<Tape> hessian_tape_;
  mutable std::optional<Tape> hessian_times_tape_;
};

}  // namespace taut::detail
