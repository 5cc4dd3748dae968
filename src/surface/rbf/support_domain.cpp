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

// Away from a sample a fit may vanish once more, as it likes: patches that say different things leave bubbles and
// tongues. They lie off the sheet, 1.6 spacings and more on an elephant and a bunny, the surface itself 0.4 at most. So
// distances across the sheet count more: the surface has to lie within a flat ellipsoid around a sample.

struct Reach {
  Vector radius;  // by sample
  double least = 0;
  double most = 0;
  double flatness = 1;  // distances across the sheet count so many times

  [[nodiscard]] bool uniform() const { return least == most && flatness == 1; }
};

class SupportEvaluator : public Evaluator {
 public:
  SupportEvaluator(const PointCloud& samples, const KdTree& tree, const Reach& reach)
      : Evaluator(samples.dim(), 1),
        samples_(samples.points),
        normals_(samples.normals),
        tree_(tree),
        reach_(reach),
        across_(reach.flatness * reach.flatness - 1) {}

  void evaluate(const PointBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Map<const Vector> x(batch.x + j * dim_, dim_);
      const Index i = supporting(x.data());
      const double distance = distance_to(i, x.data());
      if (batch.value != nullptr) batch.value[j] = reach_.radius(i) - distance;
      if (batch.jacobian == nullptr && batch.hessian == nullptr) continue;
      // With M = I + (flatness^2 - 1) n n^T the distance is sqrt(e^T M e), its gradient M e / distance. NaN distances
      // go into the direction, a sample itself has none.
      Vector away = x - samples_.col(i);
      if (across_ != 0) away += across_ * normals_.col(i).dot(away) * normals_.col(i);
      if (distance == 0) {
        away.setZero();
      } else {
        away /= distance;
      }
      if (batch.jacobian != nullptr) Eigen::Map<Vector>(batch.jacobian + j * dim_, dim_) = -away;
      if (batch.hessian != nullptr) {
        Eigen::Map<Eigen::MatrixXd> hessian(batch.hessian + j * dim_ * dim_, dim_, dim_);
        if (distance == 0) {
          hessian.setZero();
        } else {
          hessian = away * away.transpose() - Eigen::MatrixXd::Identity(dim_, dim_);
          if (across_ != 0) hessian -= across_ * normals_.col(i) * normals_.col(i).transpose();
          hessian *= batch.weight[j] / distance;
        }
      }
    }
  }

  /// The distance to the nearest sample changes by no more than one moves; of its radius the least and the most are
  /// known. Across the sheet a distance counts once at least and `flatness` times at most.
  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Map<const Vector> lower(batch.lower + j * dim_, dim_);
      const Eigen::Map<const Vector> upper(batch.upper + j * dim_, dim_);
      const Vector middle = 0.5 * (lower + upper);
      const double reach = (upper - middle).cwiseMax(middle - lower).norm();
      const double distance = std::sqrt(tree_.nearest(middle.data()).squared_distance);
      const double slack = 16 * std::numeric_limits<double>::epsilon() *
                           (distance + reach_.most + reach + middle.lpNorm<Eigen::Infinity>());
      batch.value_lower[j] = reach_.least - reach_.flatness * (distance + reach + slack) - slack;
      batch.value_upper[j] = std::min(reach_.most - distance + reach + slack, reach_.most);
    }
    return true;
  }

 private:
  [[nodiscard]] double distance_to(Index i, const double* x) const {
    double squared = 0;
    double across = 0;
    for (Index a = 0; a < dim_; ++a) {
      const double e = x[a] - samples_(a, i);
      squared += e * e;
      if (across_ != 0) across += e * normals_(a, i);
    }
    return std::sqrt(squared + across_ * across * across);
  }

  Index supporting(const double* x) {
    if (reach_.uniform()) return tree_.nearest(x).index;
    tree_.nearest(x, kAsked, found_);
    if (found_.empty()) return tree_.nearest(x).index;  // NaN
    Index best = found_.front().index;
    double most = reach_.radius(best) - distance_to(best, x);
    for (const Neighbour& q : found_) {
      const double value = reach_.radius(q.index) - distance_to(q.index, x);
      if (value > most) {
        most = value;
        best = q.index;
      }
    }
    return best;
  }

  const Points& samples_;
  const Points& normals_;
  const KdTree& tree_;
  const Reach& reach_;
  double across_;  // flatness^2 - 1
  std::vector<Neighbour> found_;
};

class SupportDomain : public ImplicitFunction {
 public:
  SupportDomain(std::shared_ptr<const PointCloud> samples, Vector radius, double flatness)
      : samples_(std::move(samples)), tree_(samples_->points) {
    reach_ = {std::move(radius), 0, 0, flatness};
    reach_.least = reach_.radius.minCoeff();
    reach_.most = reach_.radius.maxCoeff();
  }
  [[nodiscard]] Index dim() const override { return samples_->dim(); }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::string_view kind() const override { return "support"; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<SupportEvaluator>(*samples_, tree_, reach_);
  }

 private:
  std::shared_ptr<const PointCloud> samples_;
  KdTree tree_;
  Reach reach_;
};

}  // namespace

std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const PointCloud> samples, Vector radius,
                                                            double flatness) {
  return std::make_shared<SupportDomain>(std::move(samples), std::move(radius), flatness);
}

}  // namespace taut::detail
