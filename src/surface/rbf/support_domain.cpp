#include "surface/rbf/support_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "surface/rbf/kd_tree.hpp"

namespace taut::detail {
namespace {

/// Among so many nearest samples the one that reaches farthest beyond x is sought, unless all reach equally far.
constexpr Index kAsked = 6;

struct Reach {
  Vector radius;  // by sample
  double least = 0;
  double most = 0;

  [[nodiscard]] bool uniform() const { return least == most; }
};

class SupportEvaluator : public Evaluator {
 public:
  SupportEvaluator(const Points& samples, const KdTree& tree, const Reach& reach)
      : Evaluator(samples.rows(), 1), samples_(samples), tree_(tree), reach_(reach) {}

  void evaluate(const PointBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Map<const Vector> x(batch.x + j * dim_, dim_);
      const Neighbour support = supporting(x.data());
      const double distance = std::sqrt(support.squared_distance);
      if (batch.value != nullptr) batch.value[j] = reach_.radius(support.index) - distance;
      if (batch.jacobian == nullptr && batch.hessian == nullptr) continue;
      // NaN distances go into the direction, a sample itself has none.
      const Vector away =
          distance == 0 ? Vector(Vector::Zero(dim_)) : Vector((x - samples_.col(support.index)) / distance);
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

  /// The distance to the nearest sample changes by no more than one moves; of its radius the least and the most are
  /// known.
  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Map<const Vector> lower(batch.lower + j * dim_, dim_);
      const Eigen::Map<const Vector> upper(batch.upper + j * dim_, dim_);
      const Vector middle = 0.5 * (lower + upper);
      const double reach = (upper - middle).cwiseMax(middle - lower).norm();
      const double distance = std::sqrt(tree_.nearest(middle.data()).squared_distance);
      const double slack = 16 * std::numeric_limits<double>::epsilon() *
                           (distance + reach_.most + reach + middle.lpNorm<Eigen::Infinity>());
      batch.value_lower[j] = reach_.least - distance - reach - slack;
      batch.value_upper[j] = std::min(reach_.most - distance + reach + slack, reach_.most);
    }
    return true;
  }

 private:
  Neighbour supporting(const double* x) {
    if (reach_.uniform()) return tree_.nearest(x);
    tree_.nearest(x, kAsked, found_);
    if (found_.empty()) return tree_.nearest(x);  // NaN
    Neighbour best = found_.front();
    const auto value = [&](const Neighbour& q) { return reach_.radius(q.index) - std::sqrt(q.squared_distance); };
    for (const Neighbour& q : found_) {
      if (value(q) > value(best)) best = q;
    }
    return best;
  }

  const Points& samples_;
  const KdTree& tree_;
  const Reach& reach_;
  std::vector<Neighbour> found_;
};

class SupportDomain : public ImplicitFunction {
 public:
  SupportDomain(std::shared_ptr<const PointCloud> samples, Vector radius)
      : samples_(std::move(samples)), tree_(samples_->points) {
    reach_ = {std::move(radius), 0, 0};
    reach_.least = reach_.radius.minCoeff();
    reach_.most = reach_.radius.maxCoeff();
  }
  [[nodiscard]] Index dim() const override { return samples_->dim(); }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::string_view kind() const override { return "support"; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<SupportEvaluator>(samples_->points, tree_, reach_);
  }

 private:
  std::shared_ptr<const PointCloud> samples_;
  KdTree tree_;
  Reach reach_;
};

}  // namespace

std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const PointCloud> samples, Vector radius) {
  return std::make_shared<SupportDomain>(std::move(samples), std::move(radius));
}

}  // namespace taut::detail
