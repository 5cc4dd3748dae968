#pragma once

// Surfaces written by hand, with derivatives by hand: what every room's tests can rely on without the formula engine,
// and examples of a user's own surface.

#include <cmath>
#include <memory>

#include "taut/surface/surface.hpp"

namespace taut::test {

/// Adapts a struct with `Index dim()`, and `double value(x)`, `Vector gradient(x)`, `MatrixXd hessian(x)` to k = 1.
template <class Scalar>
class ScalarFunction : public ImplicitFunction {
 public:
  explicit ScalarFunction(Scalar f) : f_(std::move(f)) {}
  [[nodiscard]] Index dim() const override { return f_.dim(); }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<ScalarEvaluator>(f_);
  }

 private:
  class ScalarEvaluator : public Evaluator {
   public:
    explicit ScalarEvaluator(const Scalar& f) : Evaluator(f.dim(), 1), f_(f) {}
    void evaluate(const PointBatch& batch) override {
      const Index d = dim_;
      for (Index j = 0; j < batch.n; ++j) {
        const Vector x = Eigen::Map<const Vector>(batch.x + j * d, d);
        if (batch.value != nullptr) batch.value[j] = f_.value(x);
        if (batch.jacobian != nullptr) Eigen::Map<Vector>(batch.jacobian + j * d, d) = f_.gradient(x);
        if (batch.hessian != nullptr) {
          Eigen::Map<Eigen::MatrixXd>(batch.hessian + j * d * d, d, d) = batch.weight[j] * f_.hessian(x);
        }
      }
    }

   private:
    Scalar f_;
  };
  Scalar f_;
};

/// sum (x_i / a_i)^2 - 1
struct EllipsoidFunction {
  Vector a;
  [[nodiscard]] Index dim() const { return a.size(); }
  [[nodiscard]] double value(const Vector& x) const { return x.cwiseQuotient(a).squaredNorm() - 1; }
  [[nodiscard]] Vector gradient(const Vector& x) const { return 2 * x.array() / a.array().square(); }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector&) const { return Vector(2 / a.array().square()).asDiagonal(); }
};

/// (x^2 + y^2 + z^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2)
struct TorusFunction {
  double R = 1;
  double r = 0.4;
  [[nodiscard]] Index dim() const { return 3; }
  [[nodiscard]] double value(const Vector& x) const {
    const double s = x.squaredNorm() + R * R - r * r;
    return s * s - 4 * R * R * (x(0) * x(0) + x(1) * x(1));
  }
  [[nodiscard]] Vector gradient(const Vector& x) const {
    const double s = x.squaredNorm() + R * R - r * r;
    Vector g = 4 * s * x;
    g(0) -= 8 * R * R * x(0);
    g(1) -= 8 * R * R * x(1);
    return g;
  }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    const double s = x.squaredNorm() + R * R - r * r;
    Eigen::MatrixXd h = 8 * x * x.transpose() + 4 * s * Eigen::MatrixXd::Identity(3, 3);
    h(0, 0) -= 8 * R * R;
    h(1, 1) -= 8 * R * R;
    return h;
  }
};

/// x^4 - 5 x^2 + y^4 - 5 y^2 + z^4 - 5 z^2 + c (the tangle cube at c = 11.8)
struct TangleCubeFunction {
  double c = 11.8;
  [[nodiscard]] Index dim() const { return 3; }
  [[nodiscard]] double value(const Vector& x) const { return (x.array().pow(4) - 5 * x.array().square()).sum() + c; }
  [[nodiscard]] Vector gradient(const Vector& x) const { return 4 * x.array().cube() - 10 * x.array(); }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    return Vector(12 * x.array().square() - 10).asDiagonal();
  }
};

template <class Scalar>
Surface make_surface(Scalar f, SurfaceExtras extras = {}) {
  return Surface(std::make_shared<ScalarFunction<Scalar>>(std::move(f)), std::move(extras));
}

inline Surface unit_sphere(Index d = 3) { return make_surface(EllipsoidFunction{Vector::Ones(d)}); }
inline Surface ellipsoid(double a, double b, double c) {
  return make_surface(EllipsoidFunction{Eigen::Vector3d(a, b, c)});
}
inline Surface torus(double R = 1, double r = 0.4) { return make_surface(TorusFunction{R, r}); }
inline Surface tangle_cube() { return make_surface(TangleCubeFunction{}); }

}  // namespace taut::test
