// A point on the edge of the domain: Newton's method for F = 0 and those inequalities that are broken, taken as
// equations. Which are broken is looked at once, at the start; a point that breaks others on the way is given up.
#include "cells/domain_edge.hpp"

#include <algorithm>

namespace taut::detail {

/// F and some components of the domain, as one function.
class DomainEdge::Stacked : public Evaluator {
 public:
  Stacked(Evaluator& function, Index codim, Evaluator& domain, Index num_inequalities, const std::vector<Index>& chosen,
          Index dim)
      : Evaluator(dim, codim + static_cast<Index>(chosen.size())),
        function_(function),
        domain_(domain),
        chosen_(chosen),
        value_(codim),
        jacobian_(dim, codim),
        domain_value_(num_inequalities),
        domain_jacobian_(dim, num_inequalities) {}

  void evaluate(const PointBatch& batch) override {
    const Index k = value_.size();
    for (Index j = 0; j < batch.n; ++j) {
      const double* x = batch.x + j * dim_;
      function_.evaluate({.n = 1, .x = x, .value = value_.data(), .jacobian = jacobian_.data()});
      domain_.evaluate({.n = 1, .x = x, .value = domain_value_.data(), .jacobian = domain_jacobian_.data()});
      for (Index i = 0; i < codim_; ++i) {
        const Index inequality = i < k ? 0 : chosen_[static_cast<std::size_t>(i - k)];
        if (batch.value != nullptr) batch.value[j * codim_ + i] = i < k ? value_(i) : domain_value_(inequality);
        if (batch.jacobian == nullptr) continue;
        Eigen::Map<Vector>(batch.jacobian + (j * codim_ + i) * dim_, dim_) =
            i < k ? jacobian_.col(i) : domain_jacobian_.col(inequality);
      }
    }
  }

 private:
  Evaluator& function_;
  Evaluator& domain_;
  const std::vector<Index>& chosen_;
  Vector value_;
  Eigen::MatrixXd jacobian_;
  Vector domain_value_;
  Eigen::MatrixXd domain_jacobian_;
};

DomainEdge::DomainEdge(const Surface& surface)
    : surface_(surface), function_(surface.make_evaluator()), domain_(surface.domain()->make_evaluator()) {}

bool DomainEdge::pull(Eigen::Ref<Eigen::MatrixXd> x, const ProjectionOptions& options, double slack) {
  const Index d = surface_.dim();
  const Index k = surface_.codim();
  Vector value(surface_.domain()->codim());
  domain_->evaluate({.n = 1, .x = x.data(), .value = value.data()});
  broken_.clear();
  for (Index i = 0; i < value.size(); ++i) {
    // A NaN counts as broken.
    if (!(value(i) >= 0)) broken_.push_back(i);
  }
  const Index num_equations = k + static_cast<Index>(broken_.size());
  // More equations than coordinates have no common point in general.
  if (num_equations > d) return false;
  Stacked stacked(*function_, k, *domain_, value.size(), broken_, d);
  Eigen::MatrixXd moved = x;
  if (!project_to_surface(stacked, d, num_equations, moved, options)(0)) return false;
  if (!surface_.inside_domain(moved, slack)(0)) return false;
  x = moved;
  return true;
}

}  // namespace taut::detail
