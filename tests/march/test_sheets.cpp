#include <Eigen/Geometry>
#include <algorithm>

#include "march/support.hpp"

namespace taut {
namespace {

/// Two unit spheres at (+-(1 + gap / 2), 0, 0): the product of their equations.
struct TwoSpheres {
  double gap;
  [[nodiscard]] Index dim() const { return 3; }
  [[nodiscard]] Vector offset(const Vector& x, double side) const {
    return x - Vector(Eigen::Vector3d(side * (1 + 0.5 * gap), 0, 0));
  }
  [[nodiscard]] double value(const Vector& x) const {
    return (offset(x, 1).squaredNorm() - 1) * (offset(x, -1).squaredNorm() - 1);
  }
  [[nodiscard]] Vector gradient(const Vector& x) const {
    const Vector a = offset(x, 1), b = offset(x, -1);
    return 2 * a * (b.squaredNorm() - 1) + 2 * b * (a.squaredNorm() - 1);
  }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    const Vector a = offset(x, 1), b = offset(x, -1);
    return 2 * Eigen::MatrixXd::Identity(3, 3) * (a.squaredNorm() + b.squaredNorm() - 2) +
           4 * (a * b.transpose() + b * a.transpose());
  }
};

TEST(Sheets, TheFrontDoesNotJumpBetweenNearlyTouchingSpheres) {
  for (const double gap : {0.2, 0.05, 0.01}) {
    const Surface surface = test::make_surface(TwoSpheres{gap});
    const Vector source = Eigen::Vector3d(2 + 0.5 * gap, 0, 0);
    SurfaceCells cells = test::all_cells(surface, source, 0.06);
    const DistanceField field = march(surface, cells, source);
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (!cells.valid(i) || cells.point(i)(0) > 0) continue;
      EXPECT_FALSE(std::isfinite(field.distance(i))) << gap;
    }
    EXPECT_GT(field.num_reached, 3000);
    EXPECT_FALSE(std::isfinite(distance_at(surface, cells, field, Eigen::Vector3d(-2 - 0.5 * gap, 0, 0))(0)));
    EXPECT_EQ(descend(surface, cells, field, Eigen::Vector3d(-2 - 0.5 * gap, 0, 0)).cols(), 0);
  }
}

/// r sin(r / a - phi): the spirals r = a (phi + m pi) swept along z, sheets pi a apart. Unrolled they are flat.
struct Roll {
  double a;
  [[nodiscard]] Index dim() const { return 3; }
  [[nodiscard]] double value(const Vector& x) const {
    const double t = std::hypot(x(0), x(1)) / a;
    return std::sin(t) * x(0) - std::cos(t) * x(1);
  }
  [[nodiscard]] Vector gradient(const Vector& x) const {
    const double r = std::hypot(x(0), x(1));
    const double c = std::cos(r / a), s = std::sin(r / a);
    const double along = (c * x(0) + s * x(1)) / (a * r);
    return Eigen::Vector3d(s + along * x(0), -c + along * x(1), 0);
  }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    Eigen::MatrixXd h(3, 3);
    constexpr double kStep = 1e-6;
    for (Index i = 0; i < 3; ++i) {
      const Vector e = kStep * Vector::Unit(3, i);
      h.col(i) = (gradient(x + e) - gradient(x - e)) / (2 * kStep);
    }
    return h;
  }
  /// Arc length of the spiral from 0 to phi.
  [[nodiscard]] double arc(double phi) const { return 0.5 * a * (phi * std::sqrt(1 + phi * phi) + std::asinh(phi)); }
  [[nodiscard]] Vector point(double phi, double z) const {
    return Eigen::Vector3d(a * phi * std::cos(phi), a * phi * std::sin(phi), z);
  }
};

/// 0.6 <= r <= 2, |z| <= 0.5.
struct RollDomain {
  [[nodiscard]] Index dim() const { return 3; }
  [[nodiscard]] double value(const Vector& x) const {
    const double r = std::hypot(x(0), x(1));
    return std::min({r - 0.6, 2.0 - r, 0.5 - std::abs(x(2))});
  }
  [[nodiscard]] Vector gradient(const Vector& x) const {
    Vector g(3);
    constexpr double kStep = 1e-6;
    for (Index i = 0; i < 3; ++i) {
      const Vector e = kStep * Vector::Unit(3, i);
      g(i) = (value(x + e) - value(x - e)) / (2 * kStep);
    }
    return g;
  }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector&) const { return Eigen::MatrixXd::Zero(3, 3); }
};

TEST(Sheets, TheFrontGoesRoundTheRoll) {
  const Roll roll{0.04};  // sheets 0.126 apart
  SurfaceExtras extras;
  extras.domain = std::make_shared<test::ScalarFunction<RollDomain>>(RollDomain{});
  extras.box = Box{Eigen::Vector3d(-2.1, -2.1, -0.6), Eigen::Vector3d(2.1, 2.1, 0.6)};
  const Surface surface = test::make_surface(roll, extras);
  const double phi0 = 0.7 / roll.a, phi1 = 1.9 / roll.a;
  const Vector source = roll.point(phi0, -0.3), target = roll.point(phi1, 0.3);
  const double truth = std::hypot(roll.arc(phi1) - roll.arc(phi0), 0.6);
  ASSERT_LT(surface.value(source).norm(), 1e-9);
  SurfaceCells cells = SurfaceCells::lazy(surface, source, 0.06);
  const DistanceField field = march(surface, cells, source, {.target = target});
  EXPECT_NEAR(field.target_distance, truth, 0.003 * truth);
  const Points line = descend(surface, cells, field, target);
  ASSERT_GE(line.cols(), 2);
  EXPECT_NEAR(test::polyline_length(line), truth, 0.01 * truth);
}

}  // namespace
}  // namespace taut
