#include "surface/stacked_function.hpp"

#include <cstddef>

namespace taut::detail {
namespace {

class StackedEvaluator final : public Evaluator {
 public:
  StackedEvaluator(const Surface& surface, const std::vector<Index>& components)
      : Evaluator(surface.dim(), surface.codim() + static_cast<Index>(components.size())),
        function_(surface.make_evaluator()),
        domain_(surface.domain()->make_evaluator()),
        components_(components),
        num_domain_(surface.domain()->codim()) {}

  void evaluate(const PointBatch& batch) override {
    const Index n = batch.n;
    const Index k = codim_ - num_chosen();
    split_weights(batch);
    PointBatch own{.n = n, .x = batch.x};
    PointBatch cut{.n = n, .x = batch.x};
    if (batch.value != nullptr) {
      value_.resize(k, n);
      domain_value_.resize(num_domain_, n);
      own.value = value_.data();
      cut.value = domain_value_.data();
    }
    if (batch.jacobian != nullptr) {
      jacobian_.resize(dim_ * k, n);
      domain_jacobian_.resize(dim_ * num_domain_, n);
      own.jacobian = jacobian_.data();
      cut.jacobian = domain_jacobian_.data();
    }
    if (batch.hessian != nullptr) {
      domain_hessian_.resize(dim_ * dim_, n);
      own.weight = weight_.data();
      own.hessian = batch.hessian;
      cut.weight = domain_weight_.data();
      cut.hessian = domain_hessian_.data();
    }
    function_->evaluate(own);
    domain_->evaluate(cut);
    if (batch.value != nullptr) {
      Eigen::Map<Points> value(batch.value, codim_, n);
      value.topRows(k) = value_;
      for (Index i = 0; i < num_chosen(); ++i) value.row(k + i) = domain_value_.row(chosen(i));
    }
    if (batch.jacobian != nullptr) {
      Eigen::Map<Points> jacobian(batch.jacobian, dim_ * codim_, n);
      jacobian.topRows(dim_ * k) = jacobian_;
      for (Index i = 0; i < num_chosen(); ++i) {
        jacobian.middleRows(dim_ * (k + i), dim_) = domain_jacobian_.middleRows(dim_ * chosen(i), dim_);
      }
    }
    if (batch.hessian != nullptr) Eigen::Map<Points>(batch.hessian, dim_ * dim_, n) += domain_hessian_;
  }

  void hessian_times(const PointBatch& batch, const double* v, double* out) override {
    split_weights(batch);
    domain_product_.resize(dim_, batch.n);
    function_->hessian_times({.n = batch.n, .x = batch.x, .weight = weight_.data()}, v, out);
    domain_->hessian_times({.n = batch.n, .x = batch.x, .weight = domain_weight_.data()}, v, domain_product_.data());
    Eigen::Map<Points>(out, dim_, batch.n) += domain_product_;
  }

 private:
  [[nodiscard]] Index num_chosen() const { return static_cast<Index>(components_.size()); }
  [[nodiscard]] Index chosen(Index i) const { return components_[static_cast<std::size_t>(i)]; }
  void split_weights(const PointBatch& batch) {
    if (batch.weight == nullptr) return;
    const Eigen::Map<const Points> weight(batch.weight, codim_, batch.n);
    weight_ = weight.topRows(codim_ - num_chosen());
    domain_weight_.setZero(num_domain_, batch.n);
    for (Index i = 0; i < num_chosen(); ++i) domain_weight_.row(chosen(i)) = weight.row(codim_ - num_chosen() + i);
  }

  std::unique_ptr<Evaluator> function_;
  std::unique_ptr<Evaluator> domain_;
  std::vector<Index> components_;
  Index num_domain_;
  Points value_, jacobian_, weight_;
  Points domain_value_, domain_jacobian_, domain_weight_, domain_hessian_, domain_product_;
};

}  // namespace

std::unique_ptr<Evaluator> StackedFunction::make_evaluator() const {
  if (components_.empty()) return surface_.make_evaluator();
  return std::make_unique<StackedEvaluator>(surface_, components_);
}

}  // namespace taut::detail
