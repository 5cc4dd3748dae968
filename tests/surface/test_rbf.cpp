// F itself: derivatives, bits, frames, the kernel at a centre, the domain. How well it fits is in test_rbf_fit.cpp.

#include "taut/surface/fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <utility>

#include "support/clouds.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

Surface fitted(const PointCloud& cloud, const RbfOptions& options = {}) {
  return make_surface(std::make_shared<RbfModel>(fit_rbf(cloud, options)));
}

Points random_points(Index d, Index n, double size, std::uint64_t seed) {
  test::Uniform uniform(seed);
  Points points(d, n);
  for (double& x : points.reshaped()) x = size * (2 * uniform() - 1);
  return points;
}

template <class Draw>
Vector random_vector(const Draw& draw) {
  Vector x(3);
  for (double& entry : x) entry = draw();
  return x;
}

Eigen::MatrixXd hessian_at(const Surface& surface, const Vector& x) { return surface.hessian(x, Vector::Ones(1)); }

/// Largest error of Jacobian and Hessian against differences of order 4 at points near the unit sphere.
std::pair<double, double> derivative_errors(const Surface& surface, Index d) {
  constexpr double h = 1e-3;
  std::pair<double, double> worst{0, 0};
  const Points at = random_points(d, 8, 1.2, 11);
  for (Index j = 0; j < at.cols(); ++j) {
    const Vector gradient = surface.jacobian(at.col(j));
    const Eigen::MatrixXd hessian = hessian_at(surface, at.col(j));
    EXPECT_EQ((hessian - Eigen::MatrixXd(hessian.transpose())).norm(), 0);
    for (Index i = 0; i < d; ++i) {
      const auto shifted = [&](double steps) { return Vector(at.col(j) + steps * h * Vector::Unit(d, i)); };
      const auto difference = [&](const auto& f) -> Points {
        return (8 * (f(shifted(1)) - f(shifted(-1))) - (f(shifted(2)) - f(shifted(-2)))) / (12 * h);
      };
      const Points slope = difference([&](const Vector& x) { return surface.value(x); });
      const Points bend = difference([&](const Vector& x) { return surface.jacobian(x); });
      worst.first = std::max(worst.first, std::abs(slope(0) - gradient(i)));
      worst.second = std::max(worst.second, (bend - hessian.col(i)).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

TEST(RbfFunction, DerivativesAreThoseOfTheValueInEveryDimension) {
  for (const RbfKernel kernel : {RbfKernel::cubic, RbfKernel::quintic}) {
    for (const Index d : {2, 3, 4, 7, 10}) {
      const Surface surface = fitted(test::sphere_cloud(d, d < 5 ? 80 : 200), {.kernel = kernel});
      const auto [gradient, hessian] = derivative_errors(surface, d);
      // Differences of order 4 with h = 1e-3, where the fourth derivative may be large: a centre is never farther than
      // about 0.3. The next order would be 1e3 times worse.
      EXPECT_LT(gradient, 1e-6) << "d = " << d;
      EXPECT_LT(hessian, kernel == RbfKernel::cubic ? 1e-3 : 1e-5) << "d = " << d;
    }
  }
}

TEST(RbfFunction, BatchGivesTheBitsOfSinglePointsWhateverElseIsAsked) {
  for (const Index d : {2, 3, 5}) {
    const Surface surface = fitted(test::sphere_cloud(d, 61));
    const Points x = random_points(d, 13, 1.5, 5);
    const auto evaluator = surface.make_evaluator();
    Points value(1, 13), jacobian(d, 13), hessian(d * d, 13), weight(1, 13);
    for (Index j = 0; j < 13; ++j) weight(j) = 0.5 + 0.1 * static_cast<double>(j);
    evaluator->evaluate({.n = 13,
                         .x = x.data(),
                         .value = value.data(),
                         .jacobian = jacobian.data(),
                         .weight = weight.data(),
                         .hessian = hessian.data()});
    for (Index j = 0; j < 13; ++j) {
      EXPECT_EQ(surface.value(x.col(j))(0), value(j));
      EXPECT_EQ(surface.jacobian(x.col(j)), jacobian.col(j));
      EXPECT_EQ(surface.hessian(x.col(j), weight.col(j)).reshaped(), hessian.col(j));
    }
  }
}

TEST(RbfFunction, NanAndInfinityPassThrough) {
  const Surface surface = fitted(test::sphere_cloud(3, 40));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(std::isnan(surface.value(Eigen::Vector3d(0, bad, 0))(0)));
    EXPECT_TRUE(surface.jacobian(Eigen::Vector3d(bad, 0, 0)).array().isNaN().any());
    EXPECT_FALSE(surface.inside_domain(Eigen::Vector3d(0, 0, bad))(0));
  }
}

TEST(RbfFunction, IsTwiceContinuousAtACentre) {
  const PointCloud cloud = test::sphere_cloud(3, 60);
  const Surface surface = fitted(cloud);
  const Vector centre = cloud.points.col(7);
  const Eigen::MatrixXd at_centre = hessian_at(surface, centre);
  ASSERT_TRUE(at_centre.allFinite());
  // r^3 has a Lipschitz Hessian: halving the distance halves the difference, from every side.
  for (const Vector& direction : {Vector(Eigen::Vector3d(1, 0, 0)), Vector(Eigen::Vector3d(-0.6, 0.8, 0))}) {
    const auto jump = [&](double t) { return (hessian_at(surface, centre + t * direction) - at_centre).norm(); };
    EXPECT_NEAR(jump(1e-6) / jump(5e-7), 2, 0.01);
    EXPECT_LT(jump(1e-9), 1e-6);
  }
}

TEST(RbfFunction, TwiceTheModelGivesTheSameBits) {
  PointCloud cloud = test::torus_cloud(300);
  const Surface small = fitted(cloud);
  cloud.points *= 2;
  const Surface large = fitted(cloud);
  const Points x = random_points(3, 20, 1, 3);
  EXPECT_EQ(large.value(2 * x), 2 * small.value(x));
  EXPECT_EQ(large.jacobian(2 * x), small.jacobian(x));
}

TEST(RbfFunction, RigidMotionsCarryOver) {
  PointCloud cloud = test::torus_cloud(400);
  const Surface before = fitted(cloud);
  const Eigen::Matrix3d turn = Eigen::HouseholderQR<Eigen::MatrixXd>(random_points(3, 3, 1, 9)).householderQ();
  const Vector shift = Eigen::Vector3d(30, -4, 7);
  cloud.points = (turn * cloud.points).colwise() + shift;
  cloud.normals = turn * cloud.normals;
  const Surface after = fitted(cloud);
  const Points x = random_points(3, 20, 1, 4);
  EXPECT_LT((after.value((turn * x).colwise() + shift) - before.value(x)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(RbfFunction, ThreadsChangeNothing) {
  const PointCloud cloud = test::torus_cloud(700);
  Context one;
  one.threads = 1;
  Context many;
  many.threads = 2;
  const RbfModel a = fit_rbf(cloud, {}, one);
  const RbfModel b = fit_rbf(cloud, {}, many);
  EXPECT_EQ(a.weights, b.weights);
  EXPECT_EQ(a.polynomial, b.polynomial);
}

// --- the domain -----------------------------------------------------------------------------------------------------

TEST(RbfDomain, HoldsTheBallsAroundItsSamplesAndLittleMore) {
  const PointCloud cloud = test::sphere_cloud(3, 200);
  const RbfModel model = fit_rbf(cloud);
  const Surface surface = make_surface(std::make_shared<RbfModel>(model));
  ASSERT_NE(surface.domain(), nullptr);
  const Surface domain(std::shared_ptr<const ImplicitFunction>(std::shared_ptr<void>(), surface.domain()));
  const Points x = random_points(3, 500, 2, 8);
  for (Index j = 0; j < x.cols(); ++j) {
    const double distance = (cloud.points.colwise() - x.col(j)).colwise().norm().minCoeff();
    const double value = domain.value(x.col(j))(0);
    EXPECT_TRUE(distance > model.support_radius || value > 0) << distance;
    EXPECT_TRUE(distance < 1.3 * model.support_radius || value < 0) << distance;
  }
  EXPECT_TRUE(std::isnan(domain.value(Vector::Constant(3, std::nan("")))(0)));
}

/// A border that paths can follow has a curvature.
TEST(RbfDomain, IsSmoothAtItsBorder) {
  const Surface surface = fitted(test::sphere_cloud(3, 200));
  const Surface domain(std::shared_ptr<const ImplicitFunction>(std::shared_ptr<void>(), surface.domain()));
  const Points directions = random_points(3, 40, 1, 31);
  const Vector one = Vector::Ones(1);
  for (Index j = 0; j < directions.cols(); ++j) {
    Vector inside = directions.col(j).normalized();
    Vector outside = 3 * inside;
    for (int k = 0; k < 60; ++k) {
      const Vector middle = (inside + outside) / 2;
      (domain.value(middle)(0) > 0 ? inside : outside) = middle;
    }
    const double h = 1e-5;
    const Vector gradient = domain.jacobian(inside);
    const Eigen::MatrixXd hessian = domain.hessian(inside, one);
    EXPECT_GT(gradient.norm(), 0.3);
    for (Index a = 0; a < 3; ++a) {
      const Vector step = h * Vector::Unit(3, a);
      const double slope = (domain.value(inside + step)(0) - domain.value(inside - step)(0)) / (2 * h);
      EXPECT_NEAR(slope, gradient(a), 1e-7);
      const Vector bend = (domain.jacobian(inside + step) - domain.jacobian(inside - step)) / (2 * h);
      EXPECT_LT((bend - hessian.col(a)).norm(), 1e-5 * (1 + hessian.norm()));
    }
  }
}

TEST(RbfDomain, BoundsHoldEveryPointOfTheBox) {
  const Surface surface = fitted(test::sphere_cloud(3, 200));
  const auto domain = surface.domain()->make_evaluator();
  const Points corner = random_points(3, 200, 2, 21);
  test::Uniform uniform(22);
  for (Index j = 0; j < corner.cols(); ++j) {
    const Vector size = random_vector([&] { return std::pow(10, -3 * uniform()); });
    const Vector upper = corner.col(j) + size;
    double low = 0;
    double high = 0;
    ASSERT_TRUE(domain->bounds(
        {.n = 1, .lower = corner.col(j).data(), .upper = upper.data(), .value_lower = &low, .value_upper = &high}));
    for (int k = 0; k < 30; ++k) {
      const Vector x = corner.col(j) + size.cwiseProduct(random_vector([&] { return std::floor(4 * uniform()) / 3; }));
      double value = 0;
      domain->evaluate({.n = 1, .x = x.data(), .value = &value});
      EXPECT_GE(value, low);
      EXPECT_LE(value, high);
    }
  }
}

TEST(RbfDomain, KeepsAClosedCloudWholeAndAWatertightMeshUncut) {
  // Strewn at random: the holes between the samples are as large as they get.
  PointCloud torus = test::torus_cloud(1500);
  EXPECT_TRUE(fitted(torus).inside_domain(test::torus_cloud(5000, 1, 0.4, 77).points).all());
  PointCloud tetrahedron{Points(3, 4), Points(3, 0), Eigen::Matrix3Xi(3, 4)};
  tetrahedron.points << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  tetrahedron.faces << 0, 0, 0, 1, 1, 2, 3, 3, 2, 3, 1, 2;
  EXPECT_EQ(fitted(tetrahedron).domain(), nullptr);
  EXPECT_EQ(fitted(torus, {.support_radius = -1}).domain(), nullptr);
}

TEST(RbfDomain, CutsTheFalseSheetBetweenTheTurnsOfARoll) {
  for (const Index n : {1000, 3000}) {
    const Surface roll = fitted(test::roll_cloud(n), {.max_samples = 1000});
    const PointCloud truth = test::roll_cloud(2000, 99);
    EXPECT_TRUE(roll.inside_domain(truth.points).all());
    // Half a turn's distance farther out, midway to the next turn.
    Points midway = truth.points;
    for (Index j = 0; j < midway.cols(); ++j) {
      const double t = std::hypot(midway(0, j), midway(2, j));
      midway(0, j) *= 1 + std::numbers::pi / t;
      midway(2, j) *= 1 + std::numbers::pi / t;
    }
    EXPECT_FALSE(roll.inside_domain(midway).any());
  }
}

TEST(RbfDomain, EndsAnOpenSheetPastItsEdge) {
  PointCloud cap = test::sphere_cloud(3, 1000);
  cap.points = cap.points.leftCols(500).eval();
  cap.normals = cap.normals.leftCols(500).eval();
  const Surface surface = fitted(cap);
  EXPECT_TRUE(surface.inside_domain(Eigen::Vector3d(0, 0, 1))(0));
  EXPECT_FALSE(surface.inside_domain(Eigen::Vector3d(0, 0, -1))(0));
  EXPECT_FALSE(surface.inside_domain(Eigen::Vector3d(std::sqrt(0.75), 0, -0.5))(0));
}

}  // namespace
}  // namespace taut
