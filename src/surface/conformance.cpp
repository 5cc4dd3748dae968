#include "taut/surface/conformance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <utility>

#include "core/random.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Everything an evaluator says about some points.
struct Sample {
  Points value;     // k x n
  Points jacobian;  // d k x n
  Points hessian;   // d d x n
};

/// Derivative of f at t = 0 by Ridders' method: central differences at shrinking steps, extrapolated to step 0.
/// Ridders 1982, "Accurate computation of F'(x) and F'(x)F''(x)".
struct Difference {
  double value = kNaN;
  double error = std::numeric_limits<double>::infinity();
};

template <class F>
Difference ridders(const F& f, double step) {
  constexpr int kSteps = 12;
  constexpr double kShrink = 1.6;
  double table[kSteps][kSteps];
  Difference best;
  for (int i = 0; i < kSteps; ++i, step /= kShrink) {
    table[0][i] = (f(step) - f(-step)) / (2 * step);
    double factor = kShrink * kShrink;
    for (int j = 1; j <= i; ++j, factor *= kShrink * kShrink) {
      table[j][i] = (table[j - 1][i] * factor - table[j - 1][i - 1]) / (factor - 1);
      const double error =
          std::max(std::abs(table[j][i] - table[j - 1][i]), std::abs(table[j][i] - table[j - 1][i - 1]));
      if (error <= best.error) best = {table[j][i], error};
    }
    // Rounding takes over: smaller steps only get worse.
    if (i > 0 && std::abs(table[i][i] - table[i - 1][i - 1]) >= 2 * best.error) break;
  }
  return best;
}

bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

class Checker {
 public:
  Checker(const ImplicitFunction& function, const Box& box, const ConformanceOptions& options)
      : function_(function),
        box_(box),
        options_(options),
        d_(function.dim()),
        k_(function.codim()),
        random_(options.seed),
        evaluator_(function.make_evaluator()) {}

  ConformanceReport run() {
    points_.resize(d_, options_.num_points);
    for (Index j = 0; j < points_.cols(); ++j) points_.col(j) = random_point(box_);
    weight_ = Points(k_, points_.cols());
    for (double& w : weight_.reshaped()) w = 2 * uniform() - 1;
    guarded(points_.col(0), [&] { sample_ = evaluate(*evaluator_, points_, weight_); });
    if (!report_.violations.empty()) return std::move(report_);

    const auto check = [&](void (Checker::*rule)()) { guarded(points_.col(0), [&] { (this->*rule)(); }); };
    check(&Checker::check_batches);
    check(&Checker::check_jacobian);
    check(&Checker::check_hessian);
    check(&Checker::check_products);
    check(&Checker::check_bounds);
    check(&Checker::check_nan);
    return std::move(report_);
  }

 private:
  double uniform() { return detail::random_share(random_); }

  Vector random_point(const Box& box) {
    Vector x(d_);
    for (Index i = 0; i < d_; ++i) x(i) = box.lower(i) + uniform() * (box.upper(i) - box.lower(i));
    return x.cwiseMax(box.lower).cwiseMin(box.upper);
  }

  Sample evaluate(Evaluator& evaluator, const Points& x, const Points& weight) const {
    Sample s{Points(k_, x.cols()), Points(d_ * k_, x.cols()), Points(d_ * d_, x.cols())};
    evaluator.evaluate({.n = x.cols(),
                        .x = x.data(),
                        .value = s.value.data(),
                        .jacobian = s.jacobian.data(),
                        .weight = weight.data(),
                        .hessian = s.hessian.data()});
    return s;
  }

  Vector value_at(const Vector& x) {
    Vector value(k_);
    evaluator_->evaluate({.n = 1, .x = x.data(), .value = value.data()});
    return value;
  }

  Points jacobian_at(const Vector& x) {
    Points jacobian(d_, k_);
    evaluator_->evaluate({.n = 1, .x = x.data(), .jacobian = jacobian.data()});
    return jacobian;
  }

  void violate(const char* rule, const Vector& point, const std::string& detail) {
    if (static_cast<Index>(report_.violations.size()) < options_.max_violations) {
      report_.violations.push_back({rule, detail, point});
    }
  }

  template <class Body>
  void guarded(const Vector& point, const Body& body) {
    try {
      body();
    } catch (const std::exception& error) {
      violate("exception", point, error.what());
    } catch (...) {
      violate("exception", point, "something that is no std::exception was thrown");
    }
  }

  /// Largest step that keeps x +- step inside the box, but a sensible one.
  double step_at(Index i) const { return 0.02 * (box_.upper(i) - box_.lower(i)); }

  void compare(const char* rule, const Vector& point, const std::string& what, double found, const Difference& expected,
               double scale) {
    const double size = std::abs(expected.value) + scale;
    const double tolerance = options_.derivative_tolerance * size;
    if (!std::isfinite(expected.value) || !(expected.error <= tolerance)) {
      ++report_.num_skipped;
      return;
    }
    ++report_.num_checks;
    if (std::abs(found - expected.value) <= tolerance + 10 * expected.error) return;
    std::ostringstream text;
    text.precision(17);
    text << what << " is " << found << ", differences give " << expected.value << " +- " << expected.error;
    violate(rule, point, text.str());
  }

  void check_jacobian() {
    const double scale = typical(sample_.jacobian);
    for (Index j = 0; j < points_.cols(); ++j) {
      const Vector x = points_.col(j);
      for (Index i = 0; i < d_; ++i) {
        for (Index component = 0; component < k_; ++component) {
          const auto along = [&](double t) {
            Vector moved = x;
            moved(i) += t;
            return value_at(moved)(component);
          };
          compare("jacobian", x, "dF_" + std::to_string(component + 1) + "/dx_" + std::to_string(i + 1),
                  sample_.jacobian(component * d_ + i, j), ridders(along, step_at(i)), scale);
        }
      }
    }
  }

  void check_hessian() {
    const double scale = typical(sample_.hessian) + typical(sample_.jacobian);
    for (Index j = 0; j < points_.cols(); ++j) {
      const Vector x = points_.col(j);
      const Eigen::Map<const Eigen::MatrixXd> h(sample_.hessian.col(j).data(), d_, d_);
      for (Index i = 0; i < d_; ++i) {
        for (Index row = i; row < d_; ++row) {
          const auto along = [&](double t) {
            Vector moved = x;
            moved(i) += t;
            return (jacobian_at(moved) * weight_.col(j))(row);
          };
          const std::string name = "weighted Hessian (" + std::to_string(row + 1) + ", " + std::to_string(i + 1) + ")";
          compare("hessian", x, name, h(row, i), ridders(along, step_at(i)), scale);
          ++report_.num_checks;
          if (!same_bits(h(row, i), h(i, row))) violate("symmetry", x, name + " differs from its mirror image");
        }
      }
    }
  }

  /// Root mean square of the finite entries: what a small derivative is measured against.
  static double typical(const Points& entries) {
    double sum = 0;
    Index count = 0;
    for (const double entry : entries.reshaped()) {
      if (!std::isfinite(entry)) continue;
      sum += entry * entry;
      ++count;
    }
    return count > 0 && std::isfinite(sum) ? std::sqrt(sum / static_cast<double>(count)) : 0;
  }

  void check_products() {
    Points v(d_, points_.cols());
    for (double& entry : v.reshaped()) entry = 2 * uniform() - 1;
    Points product(d_, points_.cols());
    evaluator_->hessian_times({.n = points_.cols(), .x = points_.data(), .weight = weight_.data()}, v.data(),
                              product.data());
    for (Index j = 0; j < points_.cols(); ++j) {
      const Eigen::Map<const Eigen::MatrixXd> h(sample_.hessian.col(j).data(), d_, d_);
      const Vector expected = h * v.col(j);
      ++report_.num_checks;
      if (!expected.allFinite()) continue;
      const double tolerance = 1e-10 * (h.norm() * v.col(j).norm() + typical(sample_.hessian));
      if ((product.col(j) - expected).norm() <= tolerance) continue;
      violate("hessian_times", points_.col(j), "hessian_times differs from the Hessian times the vector");
    }
  }

  void check_batches() {
    const std::unique_ptr<Evaluator> other = function_.make_evaluator();
    for (Index j = 0; j < points_.cols(); ++j) {
      const Vector x = points_.col(j);
      Vector value(k_);
      Vector jacobian(d_ * k_);
      Vector hessian(d_ * d_);
      other->evaluate({.n = 1, .x = x.data(), .value = value.data()});
      other->evaluate({.n = 1, .x = x.data(), .jacobian = jacobian.data()});
      other->evaluate({.n = 1, .x = x.data(), .weight = weight_.col(j).data(), .hessian = hessian.data()});
      compare_bits(x, "value", sample_.value.col(j), value);
      compare_bits(x, "Jacobian", sample_.jacobian.col(j), jacobian);
      compare_bits(x, "Hessian", sample_.hessian.col(j), hessian);
    }
    // The points in reverse: a value must not depend on its neighbours.
    const Points reversed = points_.rowwise().reverse();
    const Sample again = evaluate(*other, reversed, weight_.rowwise().reverse());
    for (Index j = 0; j < points_.cols(); ++j) {
      const Index mirror = points_.cols() - 1 - j;
      compare_bits(points_.col(j), "value", sample_.value.col(j), again.value.col(mirror));
      compare_bits(points_.col(j), "Jacobian", sample_.jacobian.col(j), again.jacobian.col(mirror));
      compare_bits(points_.col(j), "Hessian", sample_.hessian.col(j), again.hessian.col(mirror));
    }
    other->evaluate({.n = 0});
  }

  void compare_bits(const Vector& x, const std::string& what, const Vector& in_batch, const Vector& alone) {
    ++report_.num_checks;
    for (Index i = 0; i < in_batch.size(); ++i) {
      if (same_bits(in_batch(i), alone(i))) continue;
      std::ostringstream text;
      text.precision(17);
      text << what << " entry " << i << " is " << in_batch(i) << " in a batch and " << alone(i) << " otherwise";
      violate("batch", x, text.str());
      return;
    }
  }

  void check_bounds() {
    constexpr Index kSamplesPerBox = 16;
    for (Index j = 0; j < points_.cols(); ++j) {
      // A box around the point, from the whole box down to 1e-12 of it.
      const double size = std::pow(10, -12 * uniform());
      const Vector half = 0.5 * size * box_.extent();
      const Box box{(points_.col(j) - half).cwiseMax(box_.lower), (points_.col(j) + half).cwiseMin(box_.upper)};
      Vector lower(k_);
      Vector upper(k_);
      if (!evaluator_->bounds({.n = 1,
                               .lower = box.lower.data(),
                               .upper = box.upper.data(),
                               .value_lower = lower.data(),
                               .value_upper = upper.data()})) {
        return;
      }
      Vector slope_lower(d_ * k_);
      Vector slope_upper(d_ * k_);
      const bool has_slopes = evaluator_->jacobian_bounds({.n = 1,
                                                           .lower = box.lower.data(),
                                                           .upper = box.upper.data(),
                                                           .jacobian_lower = slope_lower.data(),
                                                           .jacobian_upper = slope_upper.data()});
      for (Index s = 0; s < kSamplesPerBox; ++s) {
        Vector x = random_point(box);
        for (Index i = 0; i < d_; ++i) {
          if (s % 4 == 0) x(i) = uniform() < 0.5 ? box.lower(i) : box.upper(i);  // a corner
        }
        const Vector value = value_at(x);
        ++report_.num_checks;
        for (Index i = 0; i < k_; ++i) {
          if (std::isnan(value(i)) || (lower(i) <= value(i) && value(i) <= upper(i))) continue;
          std::ostringstream text;
          text.precision(17);
          text << "F_" << i + 1 << " = " << value(i) << " lies outside of [" << lower(i) << ", " << upper(i)
               << "], the bounds of a box of relative size " << size << " around it";
          violate("bounds", x, text.str());
        }
        if (!has_slopes) continue;
        const Points slope = jacobian_at(x);
        ++report_.num_checks;
        for (Index e = 0; e < d_ * k_; ++e) {
          if (!(slope.data()[e] < slope_lower(e)) && !(slope.data()[e] > slope_upper(e))) continue;
          std::ostringstream text;
          text.precision(17);
          text << "dF_" << e / d_ + 1 << "/dx_" << e % d_ + 1 << " = " << slope.data()[e] << " lies outside of ["
               << slope_lower(e) << ", " << slope_upper(e) << "], the bounds of a box of relative size " << size
               << " around it";
          violate("bounds", x, text.str());
        }
      }
    }
  }

  void check_nan() {
    for (Index i = 0; i < d_; ++i) {
      Vector x = points_.col(0);
      x(i) = kNaN;
      ++report_.num_checks;
      if (!value_at(x).array().isNaN().any()) {
        violate("nan", x, "coordinate " + std::to_string(i + 1) + " is NaN and F is not");
      }
      for (const double extreme : {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::max()}) {
        x(i) = extreme;
        guarded(x, [&] { (void)evaluate(*evaluator_, x, weight_.col(0)); });
      }
    }
  }

  const ImplicitFunction& function_;
  const Box& box_;
  const ConformanceOptions& options_;
  const Index d_;
  const Index k_;
  std::mt19937_64 random_;
  std::unique_ptr<Evaluator> evaluator_;
  Points points_;
  Points weight_;
  Sample sample_;
  ConformanceReport report_;
};

}  // namespace

std::string ConformanceReport::text() const {
  std::ostringstream result;
  for (const ConformanceViolation& violation : violations) {
    result << violation.rule << " at (" << violation.point.transpose().format(Eigen::IOFormat(17, 0, ", "))
           << "): " << violation.detail << '\n';
  }
  return result.str();
}

ConformanceReport check_conformance(const ImplicitFunction& function, const Box& box,
                                    const ConformanceOptions& options) {
  if (box.lower.size() != function.dim() || box.upper.size() != function.dim()) {
    throw InvalidArgument("the box has dimension " + std::to_string(box.dim()) + ", the function has " +
                          std::to_string(function.dim()));
  }
  if (!box.lower.allFinite() || !box.upper.allFinite() || (box.lower.array() > box.upper.array()).any()) {
    throw InvalidArgument("the box to check in must be finite, with lower <= upper");
  }
  if (options.num_points < 1) throw InvalidArgument("num_points must be at least 1");
  return Checker(function, box, options).run();
}

}  // namespace taut
