// Where the samples speak for a surface, as a smooth function whose zero set is a border that paths can follow.
//
// Sample i says b_i = 1 - d_i^2 / rho_i^2, d_i its distance and rho_i somewhat more than its radius r_i; together they
// say the 4-norm of what is positive,
//   B = (sum_i max(b_i, 0)^4)^(1/4),   g = unit (B - level),   level = 1 - (r / rho)^2.
// A sample alone ends r_i away. The largest of all b_i would do so everywhere, but along a row of samples its border is
// a row of arcs with corners between them, and to follow it would be to step from corner to corner. B is C^3 wherever
// it is positive, and beside a rim its level set is straight to a hundredth of a spacing. The sum over a whole sheet
// reaches 3 to 5 % farther across than r.
//
// Where no sample speaks, b of the nearest one leads back: that is continuous with B for one sample, and jumps far
// outside for several.
//
// Away from a sample a fit may vanish once more, as it likes: patches that say different things leave bubbles and
// tongues. They lie off the sheet, 1.6 spacings and more on an elephant and a bunny, the surface itself 0.4 at most. So
// distances across the sheet count more: d^2 = e . (I + (flatness^2 - 1) n n^T) e.
#include "surface/rbf/support_domain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "surface/rbf/cloud_geometry.hpp"
#include "surface/rbf/stabbed_balls.hpp"
#include "surface/sign_evaluator.hpp"

namespace taut::detail {
namespace {

/// rho of r. More smooths the border more, and lets a sheet reach farther across: 1.5 by 14 %.
constexpr double kRho = 1.3;
constexpr double kLevel = 1 - 1 / (kRho * kRho);
/// Boxes that more samples reach are not looked at in detail: they hold surface for all anyone knows.
constexpr std::size_t kMostInBox = 256;
/// Sums of fourth powers below this are nobody's word.
constexpr double kSilence = 1e-60;
constexpr double kRounding = 1e-12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Support {
  Support(const PointCloud& cloud, const Vector& radius, double flat)
      : balls(cloud.points, kRho * radius),
        points(cloud.points),
        normals(cloud.normals),
        flatness(flat),
        across(flat * flat - 1),
        unit(quantile(radius, 0.5) * kRho * kRho / 2),
        least_rho(kRho * radius.minCoeff()) {}

  StabbedBalls balls;
  const Points& points;
  const Points& normals;
  double flatness;  // distances across the sheet count so many times
  double across;    // flatness^2 - 1
  double unit;      // so that |grad g| is 1 where a sample of median radius ends alone
  double least_rho;

  [[nodiscard]] double rho(Index i) const { return balls.radius(i); }
  /// Squared distance from sample i to x.
  [[nodiscard]] double squared(Index i, const double* x) const {
    double sum = 0;
    double along = 0;
    for (Index a = 0; a < points.rows(); ++a) {
      const double e = x[a] - points(a, i);
      sum += e * e;
      if (across != 0) along += e * normals(a, i);
    }
    return sum + across * along * along;
  }
};

class SupportEvaluator : public SignEvaluator {
 public:
  explicit SupportEvaluator(const Support& support)
      : SignEvaluator(support.points.rows(), 1), s_(support), gradient_(dim_), away_(dim_), hessian_(dim_, dim_) {}

  void evaluate(const PointBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const double value = at(batch.x + j * dim_, batch.jacobian != nullptr, batch.hessian != nullptr);
      if (batch.value != nullptr) batch.value[j] = value;
      if (batch.jacobian != nullptr) Eigen::Map<Vector>(batch.jacobian + j * dim_, dim_) = gradient_;
      if (batch.hessian != nullptr) {
        Eigen::Map<Eigen::MatrixXd>(batch.hessian + j * dim_ * dim_, dim_, dim_) = batch.weight[j] * hessian_;
      }
    }
  }

  /// A sample that holds x alone says enough, and those near the last point asked for are near the next one as a rule.
  void are_nonnegative(Index n, const double* x, bool* answer) override {
    for (Index j = 0; j < n; ++j, x += dim_) {
      answer[j] = is_held(x);
      if (answer[j]) continue;
      s_.balls.stabbed(x, found_);
      near_ = found_;
      answer[j] = said_by_found(x, false, false) >= 0;
    }
  }

  /// From above, the sum of what each sample may say at most; from below, what the one that says most at the middle, or
  /// the nearest one, will say at least.
  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const double* lower = batch.lower + j * dim_;
      const double* upper = batch.upper + j * dim_;
      double reach = 0;
      for (Index a = 0; a < dim_; ++a) {
        away_(a) = 0.5 * (lower[a] + upper[a]);
        const double half = std::max(upper[a] - away_(a), away_(a) - lower[a]);
        reach += half * half;
      }
      reach = std::sqrt(reach) * (1 + kRounding);
      batch.value_lower[j] = -kInfinity;
      batch.value_upper[j] = kInfinity;
      const Index nearest = s_.balls.nearest(away_.data());
      if (nearest < 0 || !std::isfinite(reach)) continue;
      double most = 0;
      const bool few = s_.balls.near_box(lower, upper, kMostInBox, found_);
      for (const Index i : found_) {
        const double middle = std::sqrt(s_.squared(i, away_.data()));
        const double least = std::max(0.0, (middle - s_.flatness * reach) / s_.rho(i));
        const double word = std::max(0.0, 1 - least * least);
        most += word * word * word * word;
      }
      double least = said_at_least(nearest, reach, s_.least_rho);
      for (const Index i : found_) {
        const double word = said_at_least(i, reach, s_.rho(i));
        if (word > 0) least = std::max(least, word);
      }
      batch.value_lower[j] = s_.unit * (least - kLevel - kRounding * (1 + std::abs(least)));
      most = few ? std::sqrt(std::sqrt(most)) : std::sqrt(std::sqrt(static_cast<double>(s_.points.cols())));
      batch.value_upper[j] = s_.unit * (most - kLevel + kRounding * (1 + most));
    }
    return true;
  }

 private:
  /// By sample i in a box around `away_`, if its ball had the radius rho.
  [[nodiscard]] double said_at_least(Index i, double reach, double rho) const {
    const double farthest = (std::sqrt(s_.squared(i, away_.data())) + s_.flatness * reach) / rho;
    return 1 - farthest * farthest;
  }

  /// Does one of the samples that were found last reach x, with room for rounding.
  bool is_held(const double* x) {
    for (std::size_t k = 0; k < near_.size(); ++k) {
      const double rho = s_.rho(near_[k]);
      if (!(s_.squared(near_[k], x) < (1 - kLevel - kRounding) * rho * rho)) continue;
      std::swap(near_[0], near_[k]);
      return true;
    }
    return false;
  }

  /// M e, with e = x - sample i, into `away_`; e . M e.
  double look(Index i, const double* x) {
    double along = 0;
    for (Index a = 0; a < dim_; ++a) {
      away_(a) = x[a] - s_.points(a, i);
      if (s_.across != 0) along += away_(a) * s_.normals(a, i);
    }
    const double squared = away_.squaredNorm() + s_.across * along * along;
    if (s_.across != 0) away_ += s_.across * along * s_.normals.col(i);
    return squared;
  }

  void add_metric(Index i, double weight) {
    hessian_.diagonal().array() += weight;
    if (s_.across != 0) hessian_ += weight * s_.across * s_.normals.col(i) * s_.normals.col(i).transpose();
  }

  double at(const double* x, bool slopes, bool bends) {
    s_.balls.stabbed(x, found_);
    return said_by_found(x, slopes, bends);
  }

  /// By the samples whose balls hold x.
  double said_by_found(const double* x, bool slopes, bool bends) {
    if (dim_ == 3 && !bends) return at_in_space(x, slopes);
    double sum = 0;
    gradient_.setZero();
    hessian_.setZero();
    for (const Index i : found_) {
      const double per_rho2 = 1 / (s_.rho(i) * s_.rho(i));
      const double rest = 1 - look(i, x) * per_rho2;
      if (!(rest > 0)) continue;
      const double rest3 = rest * rest * rest;
      sum += rest3 * rest;
      // b_a = -2 (M e)_a / rho^2, (b^4)_ab = 12 b^2 b_a b_b + 4 b^3 b_ab.
      if (slopes || bends) gradient_ -= 8 * rest3 * per_rho2 * away_;
      if (bends) {
        hessian_ += 48 * rest * rest * per_rho2 * per_rho2 * away_ * away_.transpose();
        add_metric(i, -8 * rest3 * per_rho2);
      }
    }
    if (!(sum > kSilence)) return of_nearest(x);
    const double root = std::sqrt(std::sqrt(sum));
    const double slope = root / (4 * sum);
    if (bends) {
      hessian_ = s_.unit * (slope * hessian_ - 0.75 * slope / sum * gradient_ * gradient_.transpose()).eval();
    }
    gradient_ *= s_.unit * slope;
    return s_.unit * (root - kLevel);
  }

  /// The same operations in the same order in space, without second derivatives: most questions are of that kind.
  double at_in_space(const double* x, bool slopes) {
    double sum = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    const Eigen::Vector3d at(x[0], x[1], x[2]);
    for (const Index i : found_) {
      Eigen::Vector3d away = at - s_.points.col(i).head<3>();
      double squared = away.squaredNorm();
      if (s_.across != 0) {
        const Eigen::Vector3d normal = s_.normals.col(i).head<3>();
        const double along = away.dot(normal);
        squared += s_.across * along * along;
        away += s_.across * along * normal;
      }
      const double per_rho2 = 1 / (s_.rho(i) * s_.rho(i));
      const double rest = 1 - squared * per_rho2;
      if (!(rest > 0)) continue;
      const double rest3 = rest * rest * rest;
      sum += rest3 * rest;
      if (slopes) gradient -= 8 * rest3 * per_rho2 * away;
    }
    if (!(sum > kSilence)) return of_nearest(x);
    const double root = std::sqrt(std::sqrt(sum));
    gradient_ = s_.unit * (root / (4 * sum)) * gradient;
    return s_.unit * (root - kLevel);
  }

  double of_nearest(const double* x) {
    const Index i = s_.balls.nearest(x);
    if (i < 0) {  // NaN
      gradient_.setConstant(kNaN);
      hessian_.setConstant(kNaN);
      return kNaN;
    }
    const double per_rho2 = 1 / (s_.rho(i) * s_.rho(i));
    const double word = 1 - look(i, x) * per_rho2;
    gradient_ = -2 * s_.unit * per_rho2 * away_;
    hessian_.setZero();
    add_metric(i, -2 * s_.unit * per_rho2);
    return s_.unit * (word - kLevel);
  }

  const Support& s_;
  std::vector<Index> found_;
  std::vector<Index> near_;  // found where `are_nonnegative` has looked last
  Vector gradient_;
  Vector away_;
  Eigen::MatrixXd hessian_;
};

class SupportDomain : public ImplicitFunction {
 public:
  SupportDomain(std::shared_ptr<const PointCloud> samples, const Vector& radius, double flatness)
      : samples_(std::move(samples)), support_(*samples_, radius, flatness) {}
  [[nodiscard]] Index dim() const override { return samples_->dim(); }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::string_view kind() const override { return "support"; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<SupportEvaluator>(support_);
  }

 private:
  std::shared_ptr<const PointCloud> samples_;
  Support support_;
};

}  // namespace

std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const PointCloud> samples,
                                                            const Vector& radius, double flatness) {
  return std::make_shared<SupportDomain>(std::move(samples), radius, flatness);
}

}  // namespace taut::detail
