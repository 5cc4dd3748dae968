#pragma once

#include <memory>

#include "surface/fitted_function.hpp"
#include "surface/rbf/kernel_sum.hpp"
#include "surface/rbf/polynomial.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// F of an RbfModel, in model units.
class RbfFunction : public FittedFunction {
 public:
  explicit RbfFunction(const RbfModel& model);
  [[nodiscard]] Index dim() const override { return origin_.size(); }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;
  [[nodiscard]] std::string_view kind() const override { return "rbf"; }
  [[nodiscard]] double residual_rms() const override { return residual_rms_; }
  [[nodiscard]] std::string doubt() const override { return doubt_; }

  /// Value, gradient (d) and Hessian (d x d) at one point; null outputs are not computed.
  void evaluate(const double* x, double* value, double* gradient, double* hessian) const;

 private:
  Vector origin_;
  double scale_;
  PolynomialSpace space_;
  Vector polynomial_;
  KernelSum sum_;
  std::string doubt_;
  double residual_rms_;
};

}  // namespace taut::detail
