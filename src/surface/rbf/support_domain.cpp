#include "surface/rbf/support_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surface/rbf/kd_tree.hpp"

namespace taut::detail {
namespace {

class SupportEvaluator : public Evaluator {
 public:
  SupportEvaluator(const Points& samples, const KdTree& tree, double radius)
      : Evaluator(samples.rows(), 1), samples_(samples), tree_(tree), radius_(radius) {}

  void evaluate(const PointBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Map<const Vector> x(batch.x + j * dim_, dim_);
      const Neighbour nearest = tree_.nearest(x.data());
      const double distance = std::sqrt(nearest.squared_distance);
      if (batch.value != nullptr) batch.value[j] = radius_ - distance;
      if (batch.jacobian == nullptr && batch.hessian == nullptr) continue;
      // NaN distances go into the direction, a sample itself has none.
      const Vector away =
          distance == 0 ? Vector(Vector::Zero(dim_)) : Vector((x - samples_.col(nearest.index)) / distance);
      if (batch.jacobian != nullptr) Eigen::Map<Vector>(batch.jacobian + j * dim_, dim_) = -away;
      if (batch.hessian != nullptr) {
        Eigen::Map<Eigen::MatrixXd> hessian(batch.hessian + j * dim_ * dim_, dim_, dim_);
        if (distance == 0) {
          hessian.setZero();
        } else {
          hessian = batch.weight[j] / distance * (away * away.transpose() - Eigen::MatrixXd::Identity(dim_, dim_));
        }
      }
    }
  }

  /// The distance changes by no more than one moves: its value at the middle, give or take half the diagonal.
  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Map<const Vector> lower(batch.lower + j * dim_, dim_);
      const Eigen::Map<const Vector> upper(batch.upper + j * dim_, dim_);
      const Vector middle = 0.5 * (lower + upper);
      const double reach = (upper - middle).cwiseMax(middle - lower).norm();
      const double value = radius_ - std::sqrt(tree_.nearest(middle.data()).squared_distance);
      const double slack = 16 * std::numeric_limits<double>::epsilon() *
                           (std::abs(value) + radius_ + reach + middle.lpNorm<Eigen::Infinity>());
      batch.value_lower[j] = value - reach - slack;
      batch.value_upper[j] = std::min(value + reach + slack, radius_);
    }
    return true;
  }

 private:
  const Points& samples_;
  const KdTree& tree_;
  double radius_;
};

class SupportDomain : public ImplicitFunction {
 public:
  explicit SupportDomain(std::shared_ptr<const RbfModel> model)
      : model_(std::move(model)), tree_(model_->samples.points) {}
  [[nodiscard]] Index dim() const override { return model_->samples.dim(); }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::string_view kind() const override { return "support"; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<SupportEvaluator>(model_->samples.points, tree_, model_->support_radius);
  }

 private:
  std::shared_ptr<const RbfModel> model_;
  KdTree tree_;
};

}  // namespace

std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const RbfModel> model) {
  return std::make_shared<SupportDomain>(std::move(model));
}

}  // namespace taut::detail
