#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "support/geodesic_start.hpp"
#include "support/surfaces.hpp"
#include "taut/curve/newton.hpp"

namespace taut {
namespace {

using std::numbers::pi;

// A function given by lambdas, k equations, for surfaces made up in a test.
struct Callback : ImplicitFunction {
  Index d, k;
  std::function<void(const Vector&, Vector&, Eigen::MatrixXd&, std::vector<Eigen::MatrixXd>&)> f;

  Callback(Index dim, Index codim, decltype(f) function) : d(dim), k(codim), f(std::move(function)) {}
  struct CallbackEvaluator : Evaluator {
    const Callback& owner;
    explicit CallbackEvaluator(const Callback& o) : Evaluator(o.d, o.k), owner(o) {}
    void evaluate(const PointBatch& batch) override {
      for (Index j = 0; j < batch.n; ++j) {
        Vector value(codim_);
        Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(dim_, codim_);
        std::vector<Eigen::MatrixXd> hessians(static_cast<std::size_t>(codim_), Eigen::MatrixXd::Zero(dim_, dim_));
        owner.f(Eigen::Map<const Vector>(batch.x + j * dim_, dim_), value, gradients, hessians);
        if (batch.value != nullptr) Eigen::Map<Vector>(batch.value + j * codim_, codim_) = value;
        if (batch.jacobian != nullptr) {
          Eigen::Map<Eigen::MatrixXd>(batch.jacobian + j * dim_ * codim_, dim_, codim_) = gradients;
        }
        if (batch.hessian != nullptr) {
          Eigen::Map<Eigen::MatrixXd> sum(batch.hessian + j * dim_ * dim_, dim_, dim_);
          sum.setZero();
          for (Index i = 0; i < codim_; ++i)
            sum += batch.weight[j * codim_ + i] * hessians[static_cast<std::size_t>(i)];
        }
      }
    }
  };
  [[nodiscard]] Index dim() const override { return d; }
  [[nodiscard]] Index codim() const override { return k; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override {
    return std::make_unique<CallbackEvaluator>(*this);
  }
};

Surface callback(Index d, Index k, decltype(Callback::f) f) {
  return Surface(std::make_shared<Callback>(d, k, std::move(f)));
}

// phi(F) for the torus F, with phi' != 0: the same surface.
Surface torus_through(double a, double b) {  // a F + b F^3
  return callback(3, 1, [a, b](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto& h) {
    const test::TorusFunction torus;
    const double f = torus.value(x);
    const Vector gradient = torus.gradient(x);
    value(0) = a * f + b * f * f * f;
    g.col(0) = (a + 3 * b * f * f) * gradient;
    h[0] = (a + 3 * b * f * f) * torus.hessian(x) + 6 * b * f * gradient * gradient.transpose();
  });
}

Points torus_start(double noise = 0.01) {
  return test::with_noise(test::integrate_geodesic(test::torus(), Eigen::Vector3d(1.4, 0, 0),
                                                   Eigen::Vector3d(0, 2, 1).normalized(), 1.8, 30),
                          noise, 3);
}

TEST(NewtonProperties, ReversingThePathKeepsTheLength) {
  const Points start = torus_start();
  const NewtonResult forth = correct_newton(test::torus(), start, {.tolerance = 1e-12});
  const NewtonResult back = correct_newton(test::torus(), start.rowwise().reverse(), {.tolerance = 1e-12});
  ASSERT_EQ(forth.status, Status::ok);
  EXPECT_NEAR(forth.length, back.length, 3e-15);
}

TEST(NewtonProperties, TheEquationIsOnlyAName) {
  const Points start = torus_start();
  const double length = correct_newton(test::torus(), start, {.tolerance = 1e-12}).length;
  for (const auto& [a, b] : {std::pair{3.0, 0.0}, {-1.0, 0.0}, {1.0, 1.0}, {1e-9, 0.0}}) {
    const NewtonResult path = correct_newton(torus_through(a, b), start, {.tolerance = 1e-12});
    ASSERT_EQ(path.status, Status::ok) << a << " " << b << " " << path.reason;
    EXPECT_NEAR(path.length, length, 3e-15) << a << " " << b;
  }
}

TEST(NewtonProperties, RigidMotionsAndScalingCarryOver) {
  const Points start = torus_start();
  const double length = correct_newton(test::torus(), start, {.tolerance = 1e-12}).length;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d shift(1, -2, 0.5);
  for (const double scale : {1.0, 1e-3, 250.0}) {
    const Surface moved = callback(3, 1, [=](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto& h) {
      const test::TorusFunction torus;
      const Vector y = turn.transpose() * (x - shift) / scale;
      value(0) = torus.value(y);
      g.col(0) = turn * torus.gradient(y) / scale;
      h[0] = turn * torus.hessian(y) * turn.transpose() / (scale * scale);
    });
    const Points moved_start = (scale * (turn * start)).colwise() + shift;
    const NewtonResult path = correct_newton(moved, moved_start, {.tolerance = 1e-11});
    ASSERT_EQ(path.status, Status::ok) << path.reason;
    EXPECT_NEAR(path.length / scale, length, 2e-14 + 2e-15 / scale);  // both within their tolerance
  }
}

TEST(NewtonProperties, OneMoreDimensionAndEquationChangeNothing) {
  const Points start = torus_start();
  const double length = correct_newton(test::torus(), start, {.tolerance = 1e-12}).length;
  const Surface embedded = callback(4, 2, [](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto& h) {
    const test::TorusFunction torus;
    const Vector y = x.head(3);
    value << torus.value(y), x(3);
    g.col(0).head(3) = torus.gradient(y);
    g(3, 1) = 1;
    h[0].topLeftCorner(3, 3) = torus.hessian(y);
  });
  Points start4 = Points::Zero(4, start.cols());
  start4.topRows(3) = start;
  const NewtonResult path = correct_newton(embedded, start4, {.tolerance = 1e-12});
  ASSERT_EQ(path.status, Status::ok) << path.reason;
  EXPECT_NEAR(path.length, length, 3e-15);
}

TEST(NewtonProperties, CliffordTorusIsFlat) {
  const double r = 0.6;
  const Surface clifford = callback(4, 2, [r](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto& h) {
    value << x.head(2).squaredNorm() - 1, x.tail(2).squaredNorm() - r * r;
    g.col(0).head(2) = 2 * x.head(2);
    g.col(1).tail(2) = 2 * x.tail(2);
    h[0].topLeftCorner(2, 2) = 2 * Eigen::Matrix2d::Identity();
    h[1].bottomRightCorner(2, 2) = 2 * Eigen::Matrix2d::Identity();
  });
  Points start(4, 21);
  for (Index j = 0; j <= 20; ++j) {
    const double a = 2.0 * static_cast<double>(j) / 20;
    const double b = -1.3 * static_cast<double>(j * j) / 400;
    start.col(j) << std::cos(a), std::sin(a), r * std::cos(b), r * std::sin(b);
  }
  const NewtonResult path = correct_newton(clifford, test::with_noise(start, 0.02, 5), {.tolerance = 1e-12});
  ASSERT_EQ(path.status, Status::ok) << path.reason;
  EXPECT_NEAR(path.length, std::hypot(2.0, r * 1.3), 4e-15);
}

TEST(NewtonProperties, FifteenPercentNoiseFindsTheSameGeodesic) {
  const double length = correct_newton(test::torus(), torus_start(0), {.tolerance = 1e-12}).length;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Points start = test::with_noise(torus_start(0), 0.15 * 0.4, seed);
    const NewtonResult path = correct_newton(test::torus(), start, {.tolerance = 1e-12});
    ASSERT_EQ(path.status, Status::ok) << "seed " << seed << " " << path.reason;
    EXPECT_NEAR(path.length, length, 3e-15) << "seed " << seed;
  }
}

TEST(NewtonProperties, CloseEndsAndRepeatedPoints) {
  Points start(3, 5);
  const Eigen::Vector3d p(1, 0, 0);
  const Eigen::Vector3d q(std::cos(1e-9), std::sin(1e-9), 0);
  start << p, p, p, q, q;
  const NewtonResult path = correct_newton(test::unit_sphere(), start);
  ASSERT_EQ(path.status, Status::ok) << path.reason;
  EXPECT_NEAR(path.length, 1e-9, path.length_error);
}

TEST(NewtonProperties, NearlyAntipodalEnds) {
  for (const double gap : {1e-3, 1e-6, 1e-9, 0.0}) {
    Points start(3, 31);
    for (Index j = 0; j <= 30; ++j) {
      const double a = (pi - gap) * static_cast<double>(j) / 30;
      start.col(j) << std::cos(a), std::sin(a), 0;
    }
    const NewtonResult path =
        correct_newton(test::unit_sphere(), test::with_noise(start, 0.01, 9), {.tolerance = 1e-10});
    ASSERT_EQ(path.status, Status::ok) << gap << " " << path.reason;
    EXPECT_NEAR(path.length, pi - gap, std::min(1e-10 * pi, path.length_error)) << gap;
  }
}

// A length of 50 on a surface of period 2 pi and negative curvature: in its homotopy class there is one geodesic only.
TEST(NewtonProperties, ALongPathKeepsItsClass) {
  const Surface gyroid = callback(3, 1, [](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto& h) {
    const Eigen::Array3d s = x.array().sin();
    const Eigen::Array3d c = x.array().cos();
    value(0) = s(0) * c(1) + s(1) * c(2) + s(2) * c(0);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      g(i, 0) = c(i) * c(j) - s(k) * s(i);
      h[0](i, i) = -s(i) * c(j) - s(k) * c(i);
      h[0](i, j) = h[0](j, i) = -c(i) * s(j);
    }
  });
  const Vector v = Eigen::Vector3d(1, 0, -1).normalized();
  const Points exact = test::integrate_geodesic(gyroid, Vector::Zero(3), v, 50, 400);
  const NewtonResult path = correct_newton(gyroid, exact, {.tolerance = 1e-11});
  ASSERT_EQ(path.status, Status::ok) << path.reason;
  EXPECT_NEAR(path.length, 50, 1e-6);
  EXPECT_TRUE(path.locally_shortest);
}

TEST(NewtonProperties, AnEndOffTheSurfaceIsSaid) {
  Points start(3, 2);
  start << 1, 0, 0, 1.001, 0, 0;
  const NewtonResult path = correct_newton(test::unit_sphere(), start);
  EXPECT_EQ(path.status, Status::not_converged);
  EXPECT_NE(path.reason.find("end"), std::string_view::npos) << path.reason;
}

// |z| makes an edge at z = 0; the path has to cross it.
TEST(NewtonProperties, ACreaseIsNotPassedOffAsSmooth) {
  const Surface roof = callback(3, 1, [](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto&) {
    value(0) = x(1) + std::abs(x(2));
    g.col(0) << 0, 1, x(2) < 0 ? -1 : 1;
  });
  Points start(3, 3);
  start.col(0) << 0, -1, 1;
  start.col(1) << 0.3, 0, 0;
  start.col(2) << 1, -1, -1;
  const NewtonResult path = correct_newton(roof, start, {.tolerance = 1e-9});
  const double truth = std::hypot(1.0, 2 * std::sqrt(2.0));
  if (path.status == Status::ok) {
    EXPECT_NEAR(path.length, truth, 1e-9 * truth);
  } else {
    EXPECT_NE(path.status, Status::ok);
    EXPECT_FALSE(path.reason.empty());
    EXPECT_LE(std::abs(path.length - truth), path.length_error);
    EXPECT_FALSE(path.locally_shortest);  // the second variation over an edge says nothing
    EXPECT_FALSE(path.index.has_value());
  }
}

TEST(NewtonProperties, TheApexOfAConeIsDiagnosed) {
  const Surface cone = callback(3, 1, [](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto& h) {
    value(0) = x(0) * x(0) + x(1) * x(1) - x(2) * x(2);
    g.col(0) << 2 * x(0), 2 * x(1), -2 * x(2);
    h[0].diagonal() << 2, 2, -2;
  });
  Points start(3, 3);
  start.col(0) << 1, 0, -1;
  start.col(1) << 0, 0, 0;
  start.col(2) << 0, 1, 1;
  const NewtonResult path = correct_newton(cone, start);
  EXPECT_EQ(path.status, Status::rank_deficient) << path.reason;
  EXPECT_FALSE(path.locally_shortest);
}

TEST(NewtonProperties, LeavingTheDomainIsSaid) {
  SurfaceExtras extras;
  extras.domain = std::make_shared<Callback>(3, 1, [](const Vector& x, Vector& value, Eigen::MatrixXd& g, auto&) {
    value(0) = 0.9 - x(2);
    g.col(0) << 0, 0, -1;
  });
  const Surface sphere = test::make_surface(test::EllipsoidFunction{Vector::Ones(3)}, extras);
  Points start(3, 3);
  start << 0.8, 0, -0.8, 0, 0, 0, 0.6, 1, 0.6;
  EXPECT_EQ(correct_newton(sphere, start).status, Status::left_domain);
  start(0, 1) = 0.1;
  start.row(2) << 0, 0.9, -1;
  start.row(0) << 1, 0.5, 0;
  EXPECT_EQ(correct_newton(sphere, start).status, Status::ok);
}

TEST(NewtonProperties, CancelledByTheCaller) {
  const std::atomic<bool> stop{true};
  Context context;
  context.cancel = &stop;
  EXPECT_THROW((void)correct_newton(test::torus(), torus_start(), {}, context), Cancelled);
}

}  // namespace
}  // namespace taut
