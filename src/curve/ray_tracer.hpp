#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "curve/find_zero.hpp"
#include "curve/ray_backend.hpp"
#include "curve/ray_jacobi.hpp"
#include "curve/ray_step.hpp"
#include "surface/sign_evaluator.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {

/// Follows one geodesic step by step: chooses the steps, stops at the end of the surface, keeps the Jacobi fields, and
/// adds up the error.
template <int D>
class RayTracer : public ExponentialMap::Backend {
 public:
  RayTracer(const Surface& surface, const ExponentialOptions& options)
      : surface_(surface), options_(options), step_(surface), jacobi_(surface.dim(), surface.codim()) {
    if (surface.domain() != nullptr) domain_ = surface.domain()->make_evaluator();
    const Index q = surface.dim() - surface.codim() - 1;
    constexpr Index kCheapFields = 8;
    with_fields_ = q >= 1 && q <= (options.conjugate ? options.max_fields : std::min(options.max_fields, kCheapFields));
    // Steps are as long as their errors allow. The resolution that the first term left out shows falls half as fast as
    // the step's error, and can be seen when that is rounding already.
    target_ = std::max(options.tolerance, kBestStep);
    constexpr double kShare = 0.4;  // of the tolerance: its square root, since the error goes with the square
    fine_ = std::max(kResolution, kShare * std::sqrt(options.tolerance));
    // What the iteration for the nodes leaves is in no estimate: well below what is allowed.
    step_.enough = std::max(kEpsilon, 1e-2 * options.tolerance);
  }

  ExponentialResult trace(const Vector& from, const Vector& direction, double length, const Context& context) override {
    ExponentialResult result = follow(from, length < 0 ? Vector(-direction) : direction, std::abs(length), context);
    if (!with_fields_ && surface_.dim() - surface_.codim() > 1) {
      widen_by_neighbours(result, from, length < 0 ? Vector(-direction) : direction, std::abs(length), context);
    }
    constexpr double kLost = 0.1;  // radians
    if (result.status == Status::ok && !(result.direction_error < kLost)) {
      stop(result, Status::not_converged, "the rays spread so much that rounding of the start decides where they end");
    }
    if (length < 0) {
      result.direction = -result.direction;
      result.length = -result.length;
      result.conjugate_searched = -result.conjugate_searched;
      if (result.conjugate_at) result.conjugate_at = -*result.conjugate_at;
    }
    return result;
  }

 private:
  using Verdict = typename RayStep<D>::Verdict;
  using Transfer = typename RayJacobi<D>::Transfer;

  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  static constexpr double kBestStep = 5e-16;
  static constexpr double kResolution = 2e-8;
  static constexpr double kFieldShare =
      0.2;                               // the fields' resolution shows the last terms kept, not the first left out
  static constexpr double kLongest = 4;  // growth of a step at most, and shrinkage of a refused one
  static constexpr double kTurnShown = 0.05;  // radians between points of the result
  static constexpr double kSmallJump = 1e-7;  // radians a step may be off where it cannot be made shorter
  static constexpr std::size_t kMostNumbers = std::size_t{1} << 23;  // kept of a ray: 64 MiB
  static constexpr int kPatience = 8;                                // refusals in a row that do not help: noise

  struct StepError {
    double x;
    double v;
    double steps;  // how many in a row are told of together
  };

  ExponentialResult follow(const Vector& from, const Vector& direction, double length, const Context& context) {
    ExponentialResult result;
    const Index evaluated = step_.num_evaluated();
    state_.x = from;
    state_.v = direction;
    points_.clear();
    errors_.clear();
    transfers_.clear();
    noise_ = 0;
    start(length);
    if (options_.points) points_.push_back(state_.x);
    result.status = Status::ok;
    while (travelled_ < length && result.status == Status::ok) {
      context.check_cancelled();
      if (result.num_steps == options_.max_steps) {
        stop(result, Status::not_converged, "used up its steps (max_steps)");
        break;
      }
      advance(result, length);
      if (result.num_steps % 256 == 0) context.report("ray", travelled_ / length);
    }
    result.point = state_.x;
    result.direction = state_.v;
    result.length = travelled_;
    if (with_fields_ && options_.conjugate) result.conjugate_searched = travelled_;
    if (options_.points) result.points = gather_points();
    add_up(result);
    result.num_evaluated = step_.num_evaluated() - evaluated;
    return result;
  }

  static void stop(ExponentialResult& result, Status status, std::string_view reason) {
    result.status = status;
    result.reason = reason;
  }

  void start(double length) {
    travelled_ = travelled_rest_ = 0;
    offset_ = 0;
    const auto outcome = step_.look(state_);
    if (outcome != RayField<D>::Outcome::regular) {
      throw SingularPoint("the surface has no tangent space at the start of the ray");
    }
    const double given = state_.v.norm();
    const Vector unit = state_.v / given;
    Vector v = unit - state_.normals * (state_.normals.transpose() * unit);
    v -= state_.normals * (state_.normals.transpose() * v);
    constexpr double kNoTangent = 1e-12;
    if (!(v.norm() > kNoTangent)) {
      throw InvalidArgument("the direction has no part tangent to the surface at the start of the ray");
    }
    state_.v = v / v.norm();
    (void)step_.look(state_);
    start_gradient_ = step_.weakest;
    const double curvature = state_.acceleration.norm();
    scale_ = std::max(state_.x.template lpNorm<Eigen::Infinity>(), std::min(length, 1 / std::max(curvature, 1e-300)));
    // Where nothing bends nothing limits a step either: look 16 times as often as the ray is long, at the least.
    const double reach = curvature * length > 0.1 ? 0.5 / curvature : 0;
    most_ = std::max(length / 16, reach);
    next_ = std::min(length, most_);
    if (with_fields_) jacobi_.start(state_);
  }

  /// One accepted step, or the end of the ray.
  void advance(ExponentialResult& result, double length) {
    const double left = (length - travelled_) - travelled_rest_;
    double h = std::min(next_, most_);
    if (h > 0.95 * left) {
      h = left;
    } else if (h > 0.5 * left) {
      h = left / 2;
    }
    const double shortest = 16 * kEpsilon * scale_;
    double offset = offset_;
    double last_error = std::numeric_limits<double>::infinity();
    int in_vain = 0;
    while (true) {
      const Verdict verdict = step_.attempt(state_, h, offset);
      offset = 0;  // whatever came of it, it is a start for another attempt from here
      double shrink = 0.5;
      if (verdict == Verdict::good) {
        if (with_fields_) jacobi_.attempt(step_);
        const double error = std::max(step_.error_v, step_.error_x / h);
        if (is_good(error, h)) return accept(result, h, length);
        const bool vain = error > allowed(h) && error > 0.3 * last_error && error < kSmallJump;
        in_vain = vain ? in_vain + 1 : 0;
        if (in_vain >= kPatience || (h <= shortest && error < kSmallJump)) {
          noise_ = std::max(noise_, 2 * error / std::max(h * step_.curvature, 1e-3));
          return accept(result, h, length);
        }
        last_error = error;
        shrink = std::clamp(growth(error, h), 0.25, 0.7);
      } else {
        shrink = verdict == Verdict::diverged ? 0.5 : 0.25;
        last_error = std::numeric_limits<double>::infinity();
      }
      if (h <= shortest) return give_up(result, verdict);
      h = std::max(shrink * h, 0.5 * shortest);
      if (verdict != Verdict::good) (void)step_.look(state_);  // its series may hold anything
    }
  }

  [[nodiscard]] double allowed(double h) const {
    return std::max(target_, noise_ * std::max(h * step_.curvature, 1e-3));
  }

  [[nodiscard]] bool is_good(double error, double h) const {
    constexpr double kSlack = 30;  // resolution steers; beyond this the error is not to be believed
    if (!(error <= allowed(h) && step_.resolution <= kSlack * fine_)) return false;
    return !with_fields_ || (jacobi_.resolution <= kSlack * fine_ && jacobi_.bend <= 4);
  }

  /// By how much the step may grow, from the error and from the resolution.
  [[nodiscard]] double growth(double error, double h) const {
    double by_resolution = step_.resolution;
    if (with_fields_) by_resolution = std::max(by_resolution, kFieldShare * jacobi_.resolution);
    constexpr int kOrder = 2 * RayStep<D>::kStages;
    double factor = std::pow(fine_ / std::max(by_resolution, 1e-30), 2.0 / kOrder);
    if (error > allowed(h)) factor = std::min(factor, std::pow(allowed(h) / error, 1.0 / kOrder));
    if (with_fields_ && jacobi_.bend > 0) factor = std::min(factor, std::sqrt(2 / jacobi_.bend));
    if (step_.num_visits > 12) factor = std::min(factor, 0.9);
    return 0.9 * factor;
  }

  void give_up(ExponentialResult& result, Verdict verdict) {
    constexpr double kWeak = 1e-6;
    const bool weak = step_.weakest < kWeak * start_gradient_;
    if (verdict == Verdict::not_finite) {
      stop(result, Status::left_domain, "the function is not finite beyond");
    } else if (verdict == Verdict::singular || weak) {
      stop(result, Status::rank_deficient, "the surface has no normal here: a singular point");
    } else {
      stop(result, Status::not_converged, "the surface has a crease here, or bends beyond what can be followed");
    }
  }

  void accept(ExponentialResult& result, double h, double length) {
    const double error = std::max(step_.error_v, step_.error_x / h);
    const double next = h * std::clamp(growth(error, h), 1 / kLongest, kLongest);
    bool left = false;
    if (domain_) {
      const double inside = domain_length(h);
      if (inside < h) {
        left = true;
        h = inside;
        if (h <= 0) return stop(result, Status::left_domain, "the surface's domain ends here");
        if (step_.attempt(state_, h, 0) != Verdict::good) return give_up(result, Verdict::good);
        if (with_fields_) jacobi_.attempt(step_);
      }
    }
    if (with_fields_ && options_.conjugate) {
      if (!result.conjugate_at) find_conjugate(result, h);
      if (result.conjugate_at) result.index += jacobi_.num_conjugate(h);
    }
    errors_.push_back({step_.error_x, step_.error_v, 1});
    result.off_surface = std::max(result.off_surface, step_.off_surface);
    const RayState<D> from = state_;
    step_.arrive(state_);
    if (with_fields_) {
      transfers_.push_back(jacobi_.transfer);
      jacobi_.accept(state_);
    }
    if (errors_.size() * static_cast<std::size_t>(jacobi_.transfer.size()) > kMostNumbers) join_steps();
    ++result.num_steps;
    noise_ *= 0.9;
    go_on(h, length);
    next_ = next;
    offset_ = 1;
    if (options_.points) add_points(from, h);
    if (left) stop(result, Status::left_domain, "the surface's domain ends here");
  }

  /// A long ray is many steps: their sum keeps what rounding takes from it.
  void go_on(double h, double length) {
    if (h == (length - travelled_) - travelled_rest_) {
      travelled_ = length;
      travelled_rest_ = 0;
      return;
    }
    const double step = h + travelled_rest_;
    const double sum = travelled_ + step;
    travelled_rest_ = step - (sum - travelled_);  // |step| is smaller
    travelled_ = sum;
  }

  /// Two steps in a row become one, so that the memory of a long ray is bounded.
  void join_steps() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < errors_.size(); i += 2, ++kept) {
      errors_[kept] = errors_[i];
      if (with_fields_) transfers_[kept] = transfers_[i];
      if (i + 1 == errors_.size()) continue;
      const StepError& next = errors_[i + 1];
      errors_[kept].x += next.x;
      errors_[kept].v += next.v;
      errors_[kept].steps += next.steps;
      if (with_fields_) transfers_[kept] = (transfers_[i + 1] * transfers_[i]).eval();
    }
    errors_.resize(kept);
    if (with_fields_) transfers_.resize(kept);
  }

  /// How much of the step lies inside the domain.
  double domain_length(double h) {
    const Index m = surface_.domain()->codim();
    const Index d = surface_.dim();
    const double slack = 64 * kEpsilon * scale_;
    constexpr Index kStages = RayStep<D>::kStages;
    const auto& t = GaussCollocation::tables();
    Points x(d, 2 * kStages);
    std::array<double, 2 * kStages> at{};
    for (Index i = 0; i < kStages; ++i) {
      x.col(2 * i) = step_.node_x().col(i);
      x.col(2 * i + 1) = step_.check_x().col(i);
      at[static_cast<std::size_t>(2 * i)] = t.node(i);
      at[static_cast<std::size_t>(2 * i + 1)] = t.check(i + 1);
    }
    std::array<bool, 2 * kStages> inside{};
    are_nonnegative(*domain_, m, x.cols(), x.data(), inside.data());
    if (std::ranges::count(inside, false) == 0) return h;
    const Eigen::VectorXd margin = domain_margin(x, m);
    double before = 0;
    for (Index j = 0; j < 2 * kStages; ++j) {
      const double tau = at[static_cast<std::size_t>(j)];
      if (margin(j) >= -slack) {
        before = tau;
        continue;
      }
      const double f_before = domain_margin(step_.point(state_, before), m)(0);
      if (!(f_before > 0)) return before * h;
      const auto roughly = [&](double u) { return domain_margin(step_.point(state_, u), m)(0); };
      double u = find_zero(roughly, before, f_before, tau, margin(j));
      // The end of a step is more accurate than its inside.
      for (int correction = 0; correction < 2; ++correction) {
        if (step_.attempt(state_, u * h, 0) != Verdict::good) break;
        const Vector end = step_.check_x().col(kStages - 1);
        const double f_end = domain_margin(end, m)(0);
        const Vector earlier = step_.point(state_, 1 - 1e-4);
        const double slope = (f_end - domain_margin(earlier, m)(0)) / 1e-4;
        const double change = f_end / slope;
        if (!std::isfinite(change) || std::abs(change) > 1e-3) break;
        u *= 1 - change;
      }
      return u * h;
    }
    return h;
  }

  /// The least of the domain's functions, as a length: negative outside.
  Eigen::VectorXd domain_margin(const PointsIn& x, Index m) {
    const Index n = x.cols();
    const Index d = x.rows();
    domain_value_.resize(m, n);
    domain_slope_.resize(d * m, n);
    domain_->evaluate({.n = n, .x = x.data(), .value = domain_value_.data(), .jacobian = domain_slope_.data()});
    Eigen::VectorXd margin(n);
    for (Index j = 0; j < n; ++j) {
      double least = std::numeric_limits<double>::infinity();
      for (Index i = 0; i < m; ++i) {
        const double slope = domain_slope_.col(j).segment(i * d, d).norm();
        const double reach = slope > 0 && std::isfinite(slope) ? domain_value_(i, j) / slope : domain_value_(i, j);
        least = std::min(least, std::isnan(reach) ? -scale_ : reach);
      }
      margin(j) = least;
    }
    return margin;
  }

  void find_conjugate(ExponentialResult& result, double h) {
    constexpr double kNear = 1e-12;  // a zero just past the step counts: it must not fall between two
    const double at_end = jacobi_.margin(h);
    if (at_end > kNear) return;
    if (!probe_) probe_.emplace(surface_);
    RayState<D> from = state_;
    RayJacobi<D> fields = jacobi_;
    const auto margin = [&](double t) {
      if (!(t > 0)) return 1.0;
      (void)probe_->look(from);
      if (probe_->attempt(from, t, 0) != Verdict::good) return std::numeric_limits<double>::quiet_NaN();
      fields.attempt(*probe_);
      return fields.margin(t);
    };
    result.conjugate_at = travelled_ + find_zero(margin, 0, 1, h, at_end);
  }

  void add_points(const RayState<D>& from, double h) {
    constexpr int kMost = 64;
    const int pieces = std::clamp(static_cast<int>(std::ceil(step_.curvature * h / kTurnShown)), 4, kMost);
    for (int i = 1; i < pieces; ++i) points_.push_back(step_.point(from, static_cast<double>(i) / pieces));
    points_.push_back(state_.x);
    if (points_.size() * static_cast<std::size_t>(surface_.dim()) > kMostNumbers) {  // every second one, and the end
      for (std::size_t j = 1; 2 * j < points_.size(); ++j) points_[j].swap(points_[2 * j]);
      points_.resize((points_.size() + 1) / 2);
      points_.back() = state_.x;
    }
  }

  /// The points between steps are interpolated; they are projected here.
  Points gather_points() {
    Points all(surface_.dim(), static_cast<Index>(points_.size()));
    for (std::size_t j = 0; j < points_.size(); ++j) all.col(static_cast<Index>(j)) = points_[j];
    const auto evaluator = surface_.make_evaluator();
    project_to_surface(*evaluator, surface_.dim(), surface_.codim(), all);
    all.col(0) = points_.front();
    all.col(all.cols() - 1) = points_.back();
    if (all.cols() == 1) {
      const Points only = all;
      all.resize(only.rows(), 2);
      all << only, only;
    }
    return all;
  }

  /// Every step's error, grown along the rest of the way; rounding, which adds up like a random walk.
  void add_up(ExponentialResult& result) {
    const Index q = jacobi_.num_fields();
    const std::size_t n = errors_.size();
    const double rounding_x = kEpsilon * std::max(state_.x.template lpNorm<Eigen::Infinity>(), scale_);
    const double rounding_v = 2 * kEpsilon;
    double value_x = 1, value_v = 0, slope_x = 0, slope_v = 1;  // what an error at a point becomes at the end
    const double curvature = state_.acceleration.norm();
    double sum_x = 0, sum_v = 0, square_x = 0, square_v = 0;
    Transfer rest;
    if (with_fields_) rest = Transfer::Identity(2 * q, 2 * q);
    for (std::size_t i = n + 1; i-- > 0;) {  // i = 0: the start itself
      const StepError made = i > 0 ? errors_[i - 1] : StepError{0, 0, 1};
      const double to_x = made.x * value_x + made.v * value_v;
      const double to_v = made.x * slope_x + made.v * slope_v;
      const double noise_x = rounding_x * value_x + rounding_v * value_v;
      const double noise_v = rounding_x * slope_x + rounding_v * slope_v;
      sum_x += to_x;
      sum_v += to_v;
      square_x += made.steps * noise_x * noise_x;
      square_v += made.steps * noise_v * noise_v;
      if (i == 0) break;
      if (with_fields_) {
        rest = (rest * transfers_[i - 1]).eval();
        value_x = std::max(1.0, size_of(rest.topLeftCorner(q, q)));
        value_v = size_of(rest.topRightCorner(q, q));
        slope_x = size_of(rest.bottomLeftCorner(q, q));
        slope_v = std::max(1.0, size_of(rest.bottomRightCorner(q, q)));
      }
    }
    result.amplification = std::max({value_x, value_v, slope_x, slope_v, 1.0});
    constexpr double kSafety = 3;
    const auto known = [](double error) {
      return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    };
    result.error = known(kSafety * (sum_x + std::sqrt(square_x)));
    result.direction_error = known(kSafety * (sum_v + std::sqrt(square_v) + curvature * result.error));
  }

  /// A bound of the 2-norm that is exact for multiples of the identity.
  template <class Matrix>
  static double size_of(const Eigen::MatrixBase<Matrix>& m) {
    const auto size = m.cwiseAbs().eval();
    return std::sqrt(size.rowwise().sum().maxCoeff() * size.colwise().sum().maxCoeff());
  }

  /// Without Jacobi fields: three rays that start a little beside this one tell how errors grow.
  void widen_by_neighbours(ExponentialResult& result, const Vector& from, const Vector& direction, double length,
                           const Context& context) {
    constexpr double kAside = 1e-6;
    const bool points = std::exchange(options_.points, false);
    double growth = 1;
    const Vector unit = direction / direction.norm();
    for (int neighbour = 0; neighbour < 3 && result.num_steps > 0; ++neighbour) {
      Vector aside(from.size());
      for (Index c = 0; c < aside.size(); ++c) {  // a fixed pattern without structure
        const double u = 0.754877666 * static_cast<double>(c + 1) + 0.569840291 * (neighbour + 1);
        aside(c) = u - std::floor(u) - 0.5;
      }
      aside *= kAside / aside.norm();
      Vector x = from;
      if (neighbour < 2) {
        const ProjectionResult projected = project_to_surface(surface_, Vector(from + scale_ * aside));
        if (!projected.converged) continue;
        x = projected.point;
      }
      const double start = std::max((x - from).norm() / scale_, kAside);
      const ExponentialResult beside = follow(x, neighbour < 2 ? unit : Vector(unit + aside), length, context);
      const double spread =
          std::max((beside.point - result.point).norm() / scale_, (beside.direction - result.direction).norm());
      growth = std::max(growth, 4 * spread / start);
    }
    options_.points = points;
    result.amplification = std::max(1.0, growth / 4);
    result.error *= growth;
    result.direction_error *= growth;
  }

  Surface surface_;
  ExponentialOptions options_;
  RayStep<D> step_;
  RayJacobi<D> jacobi_;
  std::optional<RayStep<D>> probe_;  // to look inside a step that is taken already
  std::unique_ptr<Evaluator> domain_;
  bool with_fields_ = false;
  double target_ = 0;
  double fine_ = 0;

  // The ray so far.
  RayState<D> state_;
  double travelled_ = 0;
  double travelled_rest_ = 0;  // what rounding took from it
  double next_ = 0;            // step to try
  double most_ = 0;            // longest step
  double offset_ = 0;          // where the next step begins on the last one's series
  double scale_ = 1;           // model units: what rounding of a point is measured by
  double start_gradient_ = 1;
  double noise_ = 0;  // error that no shorter step makes smaller, to h |a|
  std::vector<Vector> points_;
  std::vector<StepError> errors_;
  std::vector<Transfer> transfers_;
  Points domain_value_, domain_slope_;
};

template <int D>
std::unique_ptr<ExponentialMap::Backend> make_ray_tracer(const Surface& surface, const ExponentialOptions& options) {
  return std::make_unique<RayTracer<D>>(surface, options);
}

}  // namespace taut::detail
