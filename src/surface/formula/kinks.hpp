#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "surface/formula/expression.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// The places where a formula, and the domain it is cut by, are not smooth: their `min`, `max`, `abs` and `sign`. Kink
/// i has a condition c_i, the difference of its branches or its argument, and takes its first branch where c_i >= 0,
/// its second where c_i <= 0. A choice of sides for all kinks turns the formula into a smooth one, a *face*. Immutable
/// but for the graph, which grows as faces are asked for: one thread's.
class FormulaKinks {
 public:
  /// One sign a kink: +1 or -1.
  using Sides = std::vector<std::int8_t>;

  /// Null when there are no kinks. Functions that are no formulas have none.
  [[nodiscard]] static std::unique_ptr<FormulaKinks> of(const ImplicitFunction& function,
                                                        const ImplicitFunction* domain = nullptr);

  [[nodiscard]] Index num_kinks() const { return static_cast<Index>(kinks_.size()); }
  /// Kinks from this one on are of the domain alone.
  [[nodiscard]] Index first_in_domain() const { return first_in_domain_; }
  /// c: R^d -> R^n, as the formula has it: itself not smooth where kinks are nested.
  [[nodiscard]] std::shared_ptr<const ImplicitFunction> conditions() const;

  /// The components of F with these sides chosen: they name the face. None when F is no formula.
  [[nodiscard]] std::vector<NodeId> face(const Sides& sides);
  /// Has the domain kinks: then `bound` says what it is.
  [[nodiscard]] bool in_domain() const { return !domain_.empty(); }
  /// Component i of the domain with these sides chosen.
  [[nodiscard]] NodeId bound(Index component, const Sides& sides);
  /// All choices that mean different faces when the sides of `open` kinks may be either: only kinks in branches that
  /// are taken are tried. At most kMostChoices.
  [[nodiscard]] std::vector<Sides> choices(const Sides& sides, const std::vector<int>& open) const;
  static constexpr std::size_t kMostChoices = 64;
  /// Condition i with these sides chosen for the kinks inside it.
  [[nodiscard]] NodeId condition(Index kink, const Sides& sides);
  /// What `face` and `condition` return, compiled.
  [[nodiscard]] std::shared_ptr<const ImplicitFunction> function(const std::vector<NodeId>& components) const;
  /// As a formula, for people.
  [[nodiscard]] std::string text(NodeId node) const;

 private:
  struct Kink {
    NodeId node;       // that is not smooth
    NodeId condition;  // in the graph as it was parsed
  };
  FormulaKinks(Graph graph, std::vector<NodeId> components, std::vector<NodeId> domain, std::size_t num_of_formula,
               Index dim);
  /// Kinks in the branches that these sides take.
  [[nodiscard]] std::vector<int> taken(const Sides& sides) const;
  [[nodiscard]] NodeId smooth(NodeId root, const Sides& sides);

  Graph graph_;
  std::vector<NodeId> components_;
  std::vector<NodeId> domain_;  // empty where it has no kinks
  std::size_t num_parsed_;      // nodes of the formula itself stand first
  Index dim_;
  std::vector<Kink> kinks_;
  Index first_in_domain_ = 0;
};

}  // namespace taut::detail
