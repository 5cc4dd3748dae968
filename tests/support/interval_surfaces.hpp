#pragma once

// Surfaces with interval bounds, from one generic lambda: evaluated on doubles, on second-order dual numbers for the
// derivatives, and on outward-rounded intervals for the bounds. Slow and obvious, for tests of what is built on bounds.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "taut/surface/surface.hpp"

namespace taut::test {

/// A closed interval; every operation rounds outwards by one unit in the last place.
struct Interval {
  double lo = 0;
  double hi = 0;
  Interval() = default;
  Interval(double x) : lo(x), hi(x) {}  // NOLINT: numbers are intervals
  Interval(double l, double h) : lo(l), hi(h) {}
};

inline Interval outward(double lo, double hi) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  return {std::nextafter(lo, -kInf), std::nextafter(hi, kInf)};
}
inline Interval operator+(Interval a, Interval b) { return outward(a.lo + b.lo, a.hi + b.hi); }
inline Interval operator-(Interval a, Interval b) { return outward(a.lo - b.hi, a.hi - b.lo); }
inline Interval operator*(Interval a, Interval b) {
  const std::array p{a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi};
  return outward(*std::min_element(p.begin(), p.end()), *std::max_element(p.begin(), p.end()));
}
inline Interval square(Interval a) {
  const double l = a.lo * a.lo;
  const double h = a.hi * a.hi;
  if (a.lo <= 0 && a.hi >= 0) return outward(0, std::max(l, h));
  return outward(std::min(l, h), std::max(l, h));
}
/// Sine of an interval: by its extrema at odd multiples of pi / 2.
inline Interval sine(Interval a) {
  const double half_pi = std::acos(0.0);
  double lo = std::min(std::sin(a.lo), std::sin(a.hi));
  double hi = std::max(std::sin(a.lo), std::sin(a.hi));
  const double first = std::ceil(a.lo / half_pi - 1e-9);
  const double last = std::floor(a.hi / half_pi + 1e-9);
  if (last - first >= 4) return {-1, 1};
  for (double q = first; q <= last; ++q) {
    const int phase = static_cast<int>(std::fmod(std::fmod(q, 4) + 4, 4));
    if (phase == 1) hi = 1;
    if (phase == 3) lo = -1;
  }
  return outward(lo, hi);
}
inline double square(double a) { return a * a; }
inline double sine(double a) { return std::sin(a); }

/// Value, gradient and Hessian carried along.
struct Dual {
  double v = 0;
  Vector g;
  Eigen::MatrixXd h;
  Dual() = default;
  Dual(double x) : v(x) {}  // NOLINT: numbers are duals
  Dual(double x, Vector gradient, Eigen::MatrixXd hessian) : v(x), g(std::move(gradient)), h(std::move(hessian)) {}
};
inline Dual add(const Dual& a, double s, const Dual& b) {
  if (a.g.size() == 0 && b.g.size() == 0) return {a.v + s * b.v};
  if (a.g.size() == 0) return {a.v + s * b.v, s * b.g, s * b.h};
  if (b.g.size() == 0) return {a.v + s * b.v, a.g, a.h};
  return {a.v + s * b.v, a.g + s * b.g, a.h + s * b.h};
}
inline Dual operator+(const Dual& a, const Dual& b) { return add(a, 1, b); }
inline Dual operator-(const Dual& a, const Dual& b) { return add(a, -1, b); }
inline Dual operator*(const Dual& a, const Dual& b) {
  if (a.g.size() == 0 && b.g.size() == 0) return {a.v * b.v};
  if (a.g.size() == 0) return {a.v * b.v, a.v * b.g, a.v * b.h};
  if (b.g.size() == 0) return {a.v * b.v, b.v * a.g, b.v * a.h};
  return {a.v * b.v, a.v * b.g + b.v * a.g, a.v * b.h + b.v * a.h + a.g * b.g.transpose() + b.g * a.g.transpose()};
}
inline Dual square(const Dual& a) { return a * a; }
inline Dual sine(const Dual& a) {
  return {std::sin(a.v), std::cos(a.v) * a.g, std::cos(a.v) * a.h - std::sin(a.v) * a.g * a.g.transpose()};
}

/// F: R^d -> R^k given by a generic callable f(x, out) with x and out vectors of T (double, Dual or Interval).
/// `with_bounds` = false hides the bounds, for what must work without.
template <class F>
class GenericFunction : public ImplicitFunction {
 public:
  GenericFunction(Index d, Index k, F f, bool with_bounds = true)
      : d_(d), k_(k), f_(std::move(f)), bounds_(with_bounds) {}
  [[nodiscard]] Index dim() const override { return d_; }
  [[nodiscard]] Index codim() const override { return k_; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override { return std::make_unique<Eval>(*this); }

 private:
  class Eval : public Evaluator {
   public:
    explicit Eval(const GenericFunction& f) : Evaluator(f.d_, f.k_), f_(f.f_), bounds_(f.bounds_) {}

    void evaluate(const PointBatch& batch) override {
      const auto d = static_cast<std::size_t>(dim_);
      const auto k = static_cast<std::size_t>(codim_);
      std::vector<Dual> x(d), y(k);
      for (Index j = 0; j < batch.n; ++j) {
        for (std::size_t a = 0; a < d; ++a) {
          x[a] = {batch.x[j * dim_ + static_cast<Index>(a)], Vector::Unit(dim_, static_cast<Index>(a)),
                  Eigen::MatrixXd::Zero(dim_, dim_)};
        }
        f_(x, y);
        if (batch.hessian != nullptr)
          Eigen::Map<Eigen::MatrixXd>(batch.hessian + j * dim_ * dim_, dim_, dim_).setZero();
        for (std::size_t i = 0; i < k; ++i) {
          const Index at = j * codim_ + static_cast<Index>(i);
          if (batch.value != nullptr) batch.value[at] = y[i].v;
          if (batch.jacobian != nullptr) Eigen::Map<Vector>(batch.jacobian + at * dim_, dim_) = y[i].g;
          if (batch.hessian != nullptr) {
            Eigen::Map<Eigen::MatrixXd>(batch.hessian + j * dim_ * dim_, dim_, dim_) += batch.weight[at] * y[i].h;
          }
        }
      }
    }

    bool bounds(const BoxBatch& batch) override {
      if (!bounds_) return false;
      const auto d = static_cast<std::size_t>(dim_);
      std::vector<Interval> x(d), y(static_cast<std::size_t>(codim_));
      for (Index j = 0; j < batch.n; ++j) {
        for (std::size_t a = 0; a < d; ++a) {
          const Index at = j * dim_ + static_cast<Index>(a);
          x[a] = {batch.lower[at], batch.upper[at]};
        }
        f_(x, y);
        for (std::size_t i = 0; i < y.size(); ++i) {
          batch.value_lower[j * codim_ + static_cast<Index>(i)] = y[i].lo;
          batch.value_upper[j * codim_ + static_cast<Index>(i)] = y[i].hi;
        }
      }
      return true;
    }

   private:
    F f_;
    bool bounds_;
  };
  Index d_, k_;
  F f_;
  bool bounds_;
};

template <class F>
std::shared_ptr<const ImplicitFunction> generic_function(Index d, Index k, F f, bool with_bounds = true) {
  return std::make_shared<GenericFunction<F>>(d, k, std::move(f), with_bounds);
}

template <class F>
Surface generic_surface(Index d, Index k, F f, bool with_bounds = true, SurfaceExtras extras = {}) {
  return Surface(generic_function(d, k, std::move(f), with_bounds), std::move(extras));
}

/// |x - centre|^2 - radius^2
inline Surface bounded_sphere(const Vector& centre, double radius, bool with_bounds = true, SurfaceExtras extras = {}) {
  return generic_surface(
      centre.size(), 1,
      [centre, radius](const auto& x, auto& y) {
        y[0] = square(x[0] - centre(0)) - radius * radius;
        for (std::size_t a = 1; a < x.size(); ++a) y[0] = y[0] + square(x[a] - centre(static_cast<Index>(a)));
      },
      with_bounds, std::move(extras));
}

inline Surface bounded_torus(double R = 1, double r = 0.4, bool with_bounds = true) {
  return generic_surface(
      3, 1,
      [R, r](const auto& x, auto& y) {
        const auto rho = square(x[0]) + square(x[1]);
        y[0] = square(rho + square(x[2]) + (R * R - r * r)) - 4 * R * R * rho;
      },
      with_bounds);
}

inline Surface bounded_tangle_cube(bool with_bounds = true) {
  return generic_surface(
      3, 1,
      [](const auto& x, auto& y) {
        y[0] = square(square(x[0]) - 2.5) + square(square(x[1]) - 2.5) + square(square(x[2]) - 2.5) + (11.8 - 18.75);
      },
      with_bounds);
}

}  // namespace taut::test
