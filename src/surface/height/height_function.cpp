#include "surface/height/height_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace taut::detail {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
/// Of the spline of what was measured. At a sample that is missing alone it is 5/9, at a measured one beside a half
/// plane of missing ones 5/6, in a corner of what was measured 25/36.
constexpr double kMeasured = 2.0 / 3;

/// A box in the plane in grid coordinates, rounding included.
std::array<double, 4> grid_box(const PixelFrame& frame, const double* lower, const double* upper) {
  const auto span = [](double low, double high, double origin, double pixel) {
    double a = (low - origin) / pixel;
    double b = (high - origin) / pixel;
    if (a > b) std::swap(a, b);
    const double slack = 4 * kEps * ((std::abs(low) + std::abs(high) + std::abs(origin)) / std::abs(pixel));
    return std::array{a - slack, b + slack};
  };
  const auto u = span(lower[0], upper[0], frame.x0, frame.pixel_x);
  const auto v = span(lower[1], upper[1], frame.y0, frame.pixel_y);
  return {u[0], u[1], v[0], v[1]};
}

class HeightEvaluator : public Evaluator {
 public:
  HeightEvaluator(std::shared_ptr<const PlaneSpline> spline, const PixelFrame& frame)
      : Evaluator(3, 1), spline_(std::move(spline)), frame_(frame) {}

  void evaluate(const PointBatch& batch) override {
    const double per_x = 1 / frame_.pixel_x;
    const double per_y = 1 / frame_.pixel_y;
    for (Index j = 0; j < batch.n; ++j) {
      const double* const x = batch.x + 3 * j;
      const PlaneSpline::Jet s = spline_->at((x[0] - frame_.x0) * per_x, (x[1] - frame_.y0) * per_y);
      if (batch.value != nullptr) batch.value[j] = x[2] - s.value;
      const double nan = x[2] - x[2];  // 0, or NaN where z is none
      if (batch.jacobian != nullptr) {
        double* const gradient = batch.jacobian + 3 * j;
        gradient[0] = nan - per_x * s.u;
        gradient[1] = nan - per_y * s.v;
        gradient[2] = 1 + nan + 0 * s.value;
      }
      if (batch.hessian != nullptr) {
        double* const h = batch.hessian + 9 * j;
        const double weight = -(batch.weight[j] + nan);
        std::fill_n(h, 9, nan);
        h[0] = weight * (per_x * per_x * s.uu);
        h[1] = h[3] = weight * (per_x * per_y * s.uv);
        h[4] = weight * (per_y * per_y * s.vv);
      }
    }
  }

  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const double* const lower = batch.lower + 3 * j;
      const double* const upper = batch.upper + 3 * j;
      const auto [u0, u1, v0, v1] = grid_box(frame_, lower, upper);
      const PlaneSpline::Range s = spline_->range(u0, u1, v0, v1);
      const double slack = 4 * kEps * (std::max(std::abs(lower[2]), std::abs(upper[2])));
      batch.value_lower[j] = lower[2] - s.upper - slack;
      batch.value_upper[j] = upper[2] - s.lower + slack;
    }
    return true;
  }

 private:
  std::shared_ptr<const PlaneSpline> spline_;
  PixelFrame frame_;
};

class HeightDomainEvaluator : public Evaluator {
 public:
  HeightDomainEvaluator(double last_u, double last_v, const PixelFrame& frame,
                        std::shared_ptr<const PlaneSpline> measured)
      : Evaluator(3, measured ? 5 : 4),
        last_u_(last_u),
        last_v_(last_v),
        frame_(frame),
        measured_(std::move(measured)) {}

  void evaluate(const PointBatch& batch) override {
    const double per_x = 1 / frame_.pixel_x;
    const double per_y = 1 / frame_.pixel_y;
    for (Index j = 0; j < batch.n; ++j) {
      const double* const x = batch.x + 3 * j;
      const double u = (x[0] - frame_.x0) * per_x;
      const double v = (x[1] - frame_.y0) * per_y;
      const double nan = x[2] - x[2];
      const PlaneSpline::Jet m = measured_ ? measured_->at(u, v) : PlaneSpline::Jet{};
      if (batch.value != nullptr) {
        double* const value = batch.value + codim_ * j;
        value[0] = u + nan;
        value[1] = last_u_ - u + nan;
        value[2] = v + nan;
        value[3] = last_v_ - v + nan;
        if (measured_) value[4] = m.value - kMeasured + nan;
      }
      if (batch.jacobian != nullptr) {
        double* const g = batch.jacobian + 3 * codim_ * j;
        std::fill_n(g, 3 * codim_, 0 * (u + v) + nan);
        g[0] += per_x;
        g[3] -= per_x;
        g[7] += per_y;
        g[10] -= per_y;
        if (measured_) {
          g[12] += per_x * m.u;
          g[13] += per_y * m.v;
        }
      }
      if (batch.hessian != nullptr) {
        double* const h = batch.hessian + 9 * j;
        std::fill_n(h, 9, 0 * (u + v) + nan);
        if (!measured_) continue;
        const double weight = batch.weight[codim_ * j + 4];
        h[0] += weight * (per_x * per_x * m.uu);
        h[1] = h[3] = h[1] + weight * (per_x * per_y * m.uv);
        h[4] += weight * (per_y * per_y * m.vv);
      }
    }
  }

  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const auto [u0, u1, v0, v1] = grid_box(frame_, batch.lower + 3 * j, batch.upper + 3 * j);
      double* const lower = batch.value_lower + codim_ * j;
      double* const upper = batch.value_upper + codim_ * j;
      const double slack = 4 * kEps * (last_u_ + last_v_);
      lower[0] = u0;
      upper[0] = u1;
      lower[1] = last_u_ - u1 - slack;
      upper[1] = last_u_ - u0 + slack;
      lower[2] = v0;
      upper[2] = v1;
      lower[3] = last_v_ - v1 - slack;
      upper[3] = last_v_ - v0 + slack;
      if (!measured_) continue;
      const PlaneSpline::Range m = measured_->range(u0, u1, v0, v1);
      lower[4] = m.lower - kMeasured;
      upper[4] = m.upper - kMeasured;
    }
    return true;
  }

 private:
  double last_u_;
  double last_v_;
  PixelFrame frame_;
  std::shared_ptr<const PlaneSpline> measured_;
};

}  // namespace

HeightFunction::HeightFunction(std::shared_ptr<const PlaneSpline> spline, const PixelFrame& frame)
    : spline_(std::move(spline)), frame_(frame) {}

std::unique_ptr<Evaluator> HeightFunction::make_evaluator() const {
  return std::make_unique<HeightEvaluator>(spline_, frame_);
}

std::optional<double> HeightFunction::height(double x, double y) const {
  const double u = (x - frame_.x0) / frame_.pixel_x;
  const double v = (y - frame_.y0) / frame_.pixel_y;
  const bool inside = u >= 0 && v >= 0 && u <= static_cast<double>(spline_->columns() - 1) &&
                      v <= static_cast<double>(spline_->rows() - 1);
  return inside ? std::optional(spline_->at(u, v).value) : std::nullopt;
}

HeightDomain::HeightDomain(Index columns, Index rows, const PixelFrame& frame,
                           std::shared_ptr<const PlaneSpline> measured)
    : last_u_(static_cast<double>(columns - 1)),
      last_v_(static_cast<double>(rows - 1)),
      frame_(frame),
      measured_(std::move(measured)) {}

std::unique_ptr<Evaluator> HeightDomain::make_evaluator() const {
  return std::make_unique<HeightDomainEvaluator>(last_u_, last_v_, frame_, measured_);
}

}  // namespace taut::detail
