#include "taut/surface/implicit_function.hpp"

#include <vector>

namespace taut {

void Evaluator::hessian_times(const PointBatch& batch, const double* v, double* out) {
  std::vector<double> hessian(static_cast<std::size_t>(dim_ * dim_ * batch.n));
  PointBatch request{.n = batch.n, .x = batch.x, .weight = batch.weight, .hessian = hessian.data()};
  evaluate(request);
  for (Index j = 0; j < batch.n; ++j) {
    Eigen::Map<const Eigen::MatrixXd> h(hessian.data() + j * dim_ * dim_, dim_, dim_);
    Eigen::Map<const Vector> v_j(v + j * dim_, dim_);
    Eigen::Map<Vector>(out + j * dim_, dim_) = h * v_j;
  }
}

bool Evaluator::bounds(const BoxBatch& /*batch*/) { return false; }

bool Evaluator::jacobian_bounds(const BoxBatch& /*batch*/) { return false; }

}  // namespace taut
