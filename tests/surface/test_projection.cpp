#include "taut/surface/projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// F: R^d -> R^k from two lambdas; the Hessian is not needed by projections.
class Lambda : public ImplicitFunction {
 public:
  using Value = std::function<Vector(const Vector&)>;
  using Jacobian = std::function<Eigen::MatrixXd(const Vector&)>;  // d x k
  Lambda(Index d, Index k, Value value, Jacobian jacobian)
      : d_(d), k_(k), value_(std::move(value)), jacobian_(std::move(jacobian)) {}
  [[nodiscard]] Index dim() const override { return d_; }
  [[nodiscard]] Index codim() const override { return k_; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override { return std::make_unique<Eval>(*this); }
  mutable int num_visits = 0;

 private:
  class Eval : public Evaluator {
   public:
    explicit Eval(const Lambda& f) : Evaluator(f.d_, f.k_), f_(f) {}
    void evaluate(const PointBatch& batch) override {
      ++f_.num_visits;
      for (Index j = 0; j < batch.n; ++j) {
        const Vector x = Eigen::Map<const Vector>(batch.x + j * dim_, dim_);
        if (batch.value != nullptr) Eigen::Map<Vector>(batch.value + j * codim_, codim_) = f_.value_(x);
        if (batch.jacobian != nullptr) {
          Eigen::Map<Eigen::MatrixXd>(batch.jacobian + j * dim_ * codim_, dim_, codim_) = f_.jacobian_(x);
        }
      }
    }

   private:
    const Lambda& f_;
  };
  Index d_, k_;
  Value value_;
  Jacobian jacobian_;
};

Surface scalar(Index d, std::function<double(const Vector&)> value, std::function<Vector(const Vector&)> gradient) {
  return Surface(std::make_shared<Lambda>(
      d, 1, [=](const Vector& x) { return Vector::Constant(1, value(x)); },
      [=](const Vector& x) -> Eigen::MatrixXd { return gradient(x); }));
}

/// x^2 + y^2 - z^2 - c: a cone at c = 0.
Surface cone(double c = 0) {
  return scalar(
      3, [c](const Vector& x) { return x(0) * x(0) + x(1) * x(1) - x(2) * x(2) - c; },
      [](const Vector& x) -> Vector { return Eigen::Vector3d(2 * x(0), 2 * x(1), -2 * x(2)); });
}

/// The Clifford torus scaled per equation: a (x^2 + y^2 - 1/2) = 0, b (z^2 + w^2 - 1/2) + m (first) = 0.
Surface clifford(double a = 1, double b = 1, double m = 0) {
  return Surface(std::make_shared<Lambda>(
      4, 2,
      [=](const Vector& x) -> Vector {
        const double f = x(0) * x(0) + x(1) * x(1) - 0.5;
        const double g = x(2) * x(2) + x(3) * x(3) - 0.5;
        return Eigen::Vector2d(a * f, b * g + m * f);
      },
      [=](const Vector& x) -> Eigen::MatrixXd {
        Eigen::MatrixXd j = Eigen::MatrixXd::Zero(4, 2);
        j.col(0).head(2) = 2 * a * x.head(2);
        j.col(1).head(2) = 2 * m * x.head(2);
        j.col(1).tail(2) = 2 * b * x.tail(2);
        return j;
      }));
}

std::string message_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const SingularPoint& error) {
    return error.what();
  }
  return "no SingularPoint";
}

TEST(Projection, ReachesTheSphereInAnyDimension) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (const Index d : {2, 3, 4, 5, 9, 50}) {
    const Surface sphere = test::unit_sphere(d);
    for (int repeat = 0; repeat < 20; ++repeat) {
      Vector x(d);
      for (auto& c : x) c = normal(random);
      const ProjectionResult result = project_to_surface(sphere, x);
      ASSERT_TRUE(result.converged);
      EXPECT_NEAR((result.point - x.normalized()).norm(), 0, 4 * kEps * std::sqrt(static_cast<double>(d)));
      EXPECT_NEAR(result.distance, std::abs(x.norm() - 1), 1e-14);
      EXPECT_LE(result.residual, 4 * kEps);
    }
  }
}

TEST(Projection, ReachesRoundingOnSurfacesOfAnySizeAndPlace) {
  for (const double radius : {1e-9, 1e-3, 1.0, 1e4}) {
    for (const double centre : {0.0, 500.0, -1e6}) {
      if (std::abs(centre) * kEps * 1000 > radius) continue;  // not a sphere any more, as computed
      const Eigen::Vector3d c(centre, 0.5 * centre, -centre);
      const Surface sphere = scalar(
          3, [=](const Vector& x) { return (x - c).squaredNorm() / (radius * radius) - 1; },
          [=](const Vector& x) -> Vector { return 2 * (x - c) / (radius * radius); });
      const Vector x = c + radius * Eigen::Vector3d(0.3, 0.8, -0.9);
      const ProjectionResult result = project_to_surface(sphere, x);
      ASSERT_TRUE(result.converged) << radius << " at " << centre;
      EXPECT_NEAR((result.point - c).norm(), radius, 8 * kEps * (radius + std::abs(centre)));
    }
  }
}

TEST(Projection, ASurfacePointStaysToRounding) {
  // The sphere through the origin: no coordinate there tells the scale of the rounding errors.
  const Surface sphere = scalar(
      3, [](const Vector& x) { return x(0) * x(0) + x(1) * x(1) + (x(2) - 1) * (x(2) - 1) - 1; },
      [](const Vector& x) -> Vector { return Eigen::Vector3d(2 * x(0), 2 * x(1), 2 * (x(2) - 1)); });
  for (const double offset : {0.0, 1e-300, 1e-20, 3e-17, 1e-16, 1.7e-15, 1e-9}) {
    const ProjectionResult result = project_to_surface(sphere, Eigen::Vector3d(offset, offset, offset));
    EXPECT_TRUE(result.converged) << offset;
    EXPECT_LE(result.distance, offset + 4 * kEps);
  }
}

TEST(Projection, ConvergesQuadratically) {
  const Surface torus = test::torus();
  const Eigen::Vector3d x(1.3, 0.2, 0.31);
  double before = 0;
  int num_quadratic = 0;
  for (int steps = 0; steps <= 5; ++steps) {
    const double residual = project_to_surface(torus, x, {.max_steps = steps}).residual;
    // |e_new| <= C |e|^2 with C of the order of the curvature, 1 / r = 2.5
    if (steps > 0 && before > 1e-7) {
      EXPECT_LE(residual, 5 * before * before + 1e-15) << steps;
      ++num_quadratic;
    }
    before = residual;
  }
  EXPECT_GE(num_quadratic, 3);
}

TEST(Projection, TakesFewStepsAndStopsAtTheTolerance) {
  const Surface torus = test::torus();
  const Eigen::Vector3d x(1.45, 0.2, 0.1);
  EXPECT_LE(project_to_surface(torus, x).num_steps, 6);
  const ProjectionResult loose = project_to_surface(torus, x, {.tolerance = 1e-3});
  EXPECT_TRUE(loose.converged);
  EXPECT_LE(loose.residual, 1e-3);
  EXPECT_LT(loose.num_steps, project_to_surface(torus, x).num_steps);
}

TEST(Projection, IntersectionsUseThePseudoInverse) {
  const Surface torus = clifford();
  const Eigen::Vector4d x(0.9, 0.2, -0.3, 0.5);
  const ProjectionResult result = project_to_surface(torus, x);
  ASSERT_TRUE(result.converged);
  // Closest point in each plane: both equations' gradients are orthogonal here.
  const Eigen::Vector2d first = x.head(2).normalized() * std::sqrt(0.5);
  const Eigen::Vector2d second = x.tail(2).normalized() * std::sqrt(0.5);
  EXPECT_LE((result.point.head(2) - first).norm(), 4 * kEps);
  EXPECT_LE((result.point.tail(2) - second).norm(), 4 * kEps);
}

TEST(Projection, MixingTheEquationsChangesOnlyRounding) {
  const Eigen::Vector4d x(0.9, 0.2, -0.3, 0.5);
  const Vector plain = project_to_surface(clifford(), x).point;
  EXPECT_LE((project_to_surface(clifford(1e-6, 1e5), x).point - plain).norm(), 8 * kEps);
  EXPECT_LE((project_to_surface(clifford(-3, 2, 40), x).point - plain).norm(), 1e-13);  // condition number about 40^2
}

TEST(Projection, NamesTheApexOfACone) {
  const std::string at = message_of([] { (void)project_to_surface(cone(), Eigen::Vector3d(0, 0, 0)); });
  EXPECT_NE(at.find("(0, 0, 0)"), std::string::npos) << at;
  // From the axis Newton's method runs into the apex, halving its distance each step.
  const std::string into = message_of([] { (void)project_to_surface(cone(), Eigen::Vector3d(0, 0, 1e-3)); });
  EXPECT_NE(into.find("(0, 0, 0.001)"), std::string::npos) << into;
}

TEST(Projection, NoFalseAlarmNearASingularity) {
  for (const double distance : {1.0, 1e-3, 1e-8, 1e-100}) {
    const ProjectionResult result = project_to_surface(cone(), Eigen::Vector3d(distance, 0, 0.9 * distance));
    ASSERT_TRUE(result.converged) << distance;
    EXPECT_NEAR(result.point(0), result.point(2), 8 * kEps * distance);
  }
  for (const double neck : {1e-2, 1e-4, 1e-8}) {
    const ProjectionResult result = project_to_surface(cone(neck * neck), Eigen::Vector3d(1e-1, 0, 0));
    ASSERT_TRUE(result.converged) << neck;
    EXPECT_NEAR(result.point(0), neck, 8 * kEps * neck);
  }
}

TEST(Projection, RefusesSquaredAndRootedEquations) {
  const auto radius = [](const Vector& x) { return x.squaredNorm() - 1; };
  const Surface squared = scalar(
      3, [=](const Vector& x) { return radius(x) * radius(x); },
      [=](const Vector& x) -> Vector { return 4 * radius(x) * x; });
  EXPECT_THROW((void)project_to_surface(squared, Eigen::Vector3d(0.9, 0.3, 0.2)), SingularPoint);
  EXPECT_THROW((void)project_to_surface(squared, Eigen::Vector3d(0.9, 0.3, 0.2), {.tolerance = 1e-10}), SingularPoint);
  // A circle in space written as one equation, sqrt((|x|^2 - 1)^2 + z^2) = 0.
  const Surface rooted = scalar(
      3, [=](const Vector& x) { return std::hypot(radius(x), x(2)); },
      [=](const Vector& x) -> Vector {
        const double f = std::hypot(radius(x), x(2));
        return (2 * radius(x) * x + x(2) * Eigen::Vector3d::UnitZ()) / f;
      });
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  for (int repeat = 0; repeat < 500; ++repeat) {
    const Eigen::Vector3d x(1 + uniform(random), uniform(random), uniform(random));
    EXPECT_THROW((void)project_to_surface(rooted, x), SingularPoint) << x.transpose();
  }
}

TEST(Projection, NamesTheEquationThatDependsOnOthers) {
  const Surface doubled(std::make_shared<Lambda>(
      3, 2, [](const Vector& x) -> Vector { return Eigen::Vector2d(1, 3) * (x.squaredNorm() - 1); },
      [](const Vector& x) -> Eigen::MatrixXd { return 2 * x * Eigen::RowVector2d(1, 3); }));
  const std::string message = message_of([&] { (void)project_to_surface(doubled, Eigen::Vector3d(0.9, 0.3, 0.2)); });
  EXPECT_NE(message.find("equation 2 depends"), std::string::npos) << message;
  // The centre of a sphere: no direction leads to the surface.
  EXPECT_THROW((void)project_to_surface(test::unit_sphere(), Eigen::Vector3d::Zero()), SingularPoint);
}

TEST(Projection, SaysWhenThereIsNoSurface) {
  const Surface empty = scalar(
      2, [](const Vector& x) { return x.squaredNorm() + 1; }, [](const Vector& x) -> Vector { return 2 * x; });
  const ProjectionResult result = project_to_surface(empty, Eigen::Vector2d(0.7, 0.1));
  EXPECT_FALSE(result.converged);
  EXPECT_GT(result.residual, 0.1);
}

TEST(Projection, AWrongJacobianIsNotTakenForRounding) {
  // A gradient of half its size: the steps overshoot to the mirror image, F stays as linear as can be.
  const Surface wrong = scalar(
      2, [](const Vector& x) { return x(0) - 0.25; }, [](const Vector&) -> Vector { return Eigen::Vector2d(0.5, 0); });
  const ProjectionResult result = project_to_surface(wrong, Eigen::Vector2d(3, 1));
  EXPECT_TRUE(!result.converged || std::abs(result.point(0) - 0.25) < 1e-12);
}

// Found on 23 November 2026: a step across the pole of a formula ended as converged with a residual of 1.6.
TEST(Projection, AJumpAcrossAPoleIsNotTakenForRounding) {
  const Surface surface = parse_surface("y/(x^2-0.6) + x - z");
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  Points starts(3, 2000);
  for (double& c : starts.reshaped()) c = coordinate(random);
  starts.col(0) << 1.370246109693469, -0.037362532504498391, -1.3114122136781912;
  Points ends = starts;
  const auto converged = project_to_surface(*surface.make_evaluator(), 3, 1, ends);
  for (Index j = 0; j < ends.cols(); ++j) {
    if (!converged(j)) continue;
    const double off = std::abs(surface.value(ends.col(j))(0)) / surface.jacobian(ends.col(j)).norm();
    EXPECT_LE(off, 1e-9) << "from " << starts.col(j).transpose();
  }
}

TEST(Projection, RespectsTheLimits) {
  const Surface sphere = test::unit_sphere();
  EXPECT_FALSE(project_to_surface(sphere, Eigen::Vector3d(3, 0, 0), {.max_distance = 1}).converged);
  EXPECT_FALSE(project_to_surface(sphere, Eigen::Vector3d(1e6, 0, 0), {.max_steps = 3}).converged);
  EXPECT_TRUE(project_to_surface(sphere, Eigen::Vector3d(1e12, 1, 0), {.max_steps = 80}).converged);
  EXPECT_THROW((void)project_to_surface(sphere, Eigen::Vector2d(1, 0)), InvalidArgument);
  EXPECT_THROW((void)project_to_surface(sphere, Eigen::Vector3d(1, std::nan(""), 0)), InvalidArgument);
  EXPECT_THROW((void)project_to_surface(sphere, Eigen::Vector3d(1, 0, 0), {.tolerance = -1}), InvalidArgument);
}

TEST(Projection, ABatchGivesWhatItsPointsGiveAlone) {
  const Surface torus = test::torus();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  Points points(3, 700);
  for (Index j = 0; j < points.cols(); ++j) points.col(j) << uniform(random), uniform(random), 0.3 * uniform(random);
  points(1, 5) = std::nan("");
  points.col(17).setZero();  // the centre of the torus: grad F = 0
  const Points before = points;
  Eigen::MatrixXd normals;
  const auto evaluator = torus.make_evaluator();
  const auto converged = project_to_surface(*evaluator, 3, 1, points, {.max_distance = 0.5}, &normals);
  EXPECT_FALSE(converged(5));
  EXPECT_FALSE(converged(17));
  EXPECT_EQ(points.col(17), before.col(17));
  Index num_far = 0;
  for (Index j = 0; j < points.cols(); ++j) {
    if (j == 5 || j == 17) continue;
    const ProjectionResult alone = project_to_surface(torus, before.col(j), {.max_distance = 0.5});
    ASSERT_EQ(converged(j), alone.converged);
    if (!alone.converged) {
      ++num_far;
      EXPECT_EQ(points.col(j), before.col(j));
      continue;
    }
    EXPECT_EQ(points.col(j), alone.point);
    const Vector gradient = torus.jacobian(alone.point);
    EXPECT_LE((normals.col(j) - gradient.normalized()).norm(), 1e-15);
  }
  EXPECT_GT(num_far, 0);
}

TEST(Projection, NormalsOfAnIntersectionAreOrthonormal) {
  const Surface torus = clifford(2, 1, 5);
  Points points = Points::Random(4, 40);
  Eigen::MatrixXd normals;
  const auto evaluator = torus.make_evaluator();
  const auto converged = project_to_surface(*evaluator, 4, 2, points, {}, &normals);
  EXPECT_TRUE(converged.all());
  const Points jacobian = torus.jacobian(points);
  for (Index j = 0; j < points.cols(); ++j) {
    const Eigen::MatrixXd q = normals.col(j).reshaped(4, 2);
    const Eigen::MatrixXd gradients = jacobian.col(j).reshaped(4, 2);
    EXPECT_LE((q.transpose() * q - Eigen::Matrix2d::Identity()).norm(), 8 * kEps);
    EXPECT_LE((gradients - q * (q.transpose() * gradients)).norm(), 1e-14 * gradients.norm());
  }
}

TEST(Projection, ABatchVisitsTheEvaluatorOnceAStep) {
  const auto function = std::make_shared<Lambda>(
      3, 1, [](const Vector& x) { return Vector::Constant(1, x.squaredNorm() - 1); },
      [](const Vector& x) -> Eigen::MatrixXd { return 2 * x; });
  Points points = Points::Random(3, 200);
  (void)project_to_surface(*function->make_evaluator(), 3, 1, points);
  EXPECT_LE(function->num_visits, 12);
}

}  // namespace
}  // namespace taut
