#include "surface/rbf/rbf_function.hpp"

#include <array>
#include <vector>

#include "surface/normals/merged_sheets.hpp"

namespace taut::detail {
namespace {

class RbfEvaluator : public Evaluator {
 public:
  explicit RbfEvaluator(const RbfFunction& function) : Evaluator(function.dim(), 1), function_(function) {}

  void evaluate(const PointBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      double* const value = batch.value != nullptr ? batch.value + j : nullptr;
      double* const gradient = batch.jacobian != nullptr ? batch.jacobian + j * dim_ : nullptr;
      double* const hessian = batch.hessian != nullptr ? batch.hessian + j * dim_ * dim_ : nullptr;
      function_.evaluate(batch.x + j * dim_, value, gradient, hessian);
      if (hessian != nullptr) {
        for (Index i = 0; i < dim_ * dim_; ++i) hessian[i] *= batch.weight[j];
      }
    }
  }

 private:
  const RbfFunction& function_;
};

}  // namespace

RbfFunction::RbfFunction(const RbfModel& model)
    : origin_(model.origin),
      scale_(model.scale),
      space_{model.origin.size(), model.kernel == RbfKernel::quintic ? 2 : 1},
      polynomial_(model.polynomial),
      sum_(model.kernel, model.centres, model.weights),
      doubt_(detail::doubt(model.report.merged_sheets, model.samples.points)),
      residual_rms_(model.report.residual_rms) {}

std::unique_ptr<Evaluator> RbfFunction::make_evaluator() const { return std::make_unique<RbfEvaluator>(*this); }

void RbfFunction::evaluate(const double* x, double* value, double* gradient, double* hessian) const {
  const Index d = dim();
  constexpr Index kOnStack = 16;
  std::array<double, kOnStack> stack;
  std::vector<double> heap;
  double* unit = stack.data();
  if (d > kOnStack) {
    heap.resize(static_cast<std::size_t>(d));
    unit = heap.data();
  }
  for (Index i = 0; i < d; ++i) unit[i] = (x[i] - origin_(i)) / scale_;
  sum_(unit, value, gradient, hessian);
  space_.add(polynomial_.data(), unit, value, gradient, hessian);
  // F = scale * F_unit((x - origin) / scale)
  if (value != nullptr) *value *= scale_;
  if (hessian != nullptr) {
    for (Index i = 0; i < d * d; ++i) hessian[i] /= scale_;
  }
}

}  // namespace taut::detail
