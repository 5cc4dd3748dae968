#include "taut/curve/exponential_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <atomic>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "curve/ray_step.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;

Vector vec(std::initializer_list<double> values) {
  Vector v(static_cast<Index>(values.size()));
  Index i = 0;
  for (const double x : values) v(i++) = x;
  return v;
}

Vector random_vector(Index d, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Vector v(d);
  for (double& x : v) x = normal(random);
  return v;
}

TEST(ExponentialMap, FollowsGreatCirclesInAnyDimension) {
  std::mt19937_64 random(7);
  for (const Index d : {2, 3, 4, 5, 10, 50, 120}) {
    SCOPED_TRACE("dimension " + std::to_string(d));
    const Vector p = random_vector(d, random).normalized();
    Vector v = random_vector(d, random);
    v = (v - p * p.dot(v)).normalized();
    for (const double s : {0.3, 4.0, -4.0}) {
      const ExponentialResult ray = exponential_map(test::unit_sphere(d), p, 17 * v, s);
      ASSERT_EQ(ray.status, Status::ok) << ray.reason;
      EXPECT_EQ(ray.length, s);
      EXPECT_LT((ray.point - (std::cos(s) * p + std::sin(s) * v)).norm(), 1e-14);
      EXPECT_LT((ray.direction - (std::cos(s) * v - std::sin(s) * p)).norm(), 1e-14);
      EXPECT_LT(ray.error, 1e-13);
      const bool searched = d > 2 && d - 2 <= 64;
      EXPECT_EQ(ray.conjugate_searched, searched ? s : 0);
      ASSERT_EQ(ray.conjugate_at.has_value(), searched && std::abs(s) > kPi);  // d - 2 conjugate points at once
      if (ray.conjugate_at) {
        EXPECT_NEAR(*ray.conjugate_at, std::copysign(kPi, s), 2e-15);
        EXPECT_EQ(ray.index, d - 2);
      } else {
        EXPECT_EQ(ray.index, 0);
      }
    }
  }
}

TEST(ExponentialMap, KeepsCountOfTheLengthOfALongRay) {
  const ExponentialResult ray = exponential_map(test::unit_sphere(), vec({1, 0, 0}), vec({0, 1, 0}), 5000);
  const double error = (ray.point - vec({std::cos(5000.0), std::sin(5000.0), 0})).norm();
  EXPECT_LT(error, 5e-12);
  EXPECT_LT(error, ray.error);
  EXPECT_EQ(ray.index, static_cast<int>(5000 / kPi));
}

TEST(ExponentialMap, FollowsHelicesOnACylinder) {
  const Surface cylinder = parse_surface("x^2+y^2=1", {.dim = 3});
  const double slope = 0.3;
  const ExponentialResult ray = exponential_map(cylinder, vec({1, 0, 0}), vec({0, 1, slope}), 40);
  const double turn = 40 / std::hypot(1, slope);
  EXPECT_LT((ray.point - vec({std::cos(turn), std::sin(turn), slope * turn})).norm(), 2e-13);
  EXPECT_EQ(ray.status, Status::ok);
  EXPECT_FALSE(ray.conjugate_at.has_value());
  EXPECT_NEAR(ray.amplification, 40, 1e-10);  // flat: fields grow like the length
}

TEST(ExponentialMap, FollowsStraightLinesOnAnUnrolledCone) {
  // x^2 + y^2 = z^2 unrolls to a sector: polar angle = longitude / sqrt 2, radius = sqrt 2 z.
  const Surface cone = parse_surface("x^2+y^2=z^2");
  for (const double aside : {1.0, 0.1, 1e-3, 1e-5}) {
    SCOPED_TRACE(aside);
    const double length = 3;
    const ExponentialResult ray = exponential_map(cone, vec({1, 0, 1}), vec({-1, aside, -1}), length);
    ASSERT_EQ(ray.status, Status::ok) << ray.reason;
    const double radial = -std::numbers::sqrt2 / std::hypot(std::numbers::sqrt2, aside);
    const double across = aside / std::hypot(std::numbers::sqrt2, aside);
    const double x = std::numbers::sqrt2 + length * radial;
    const double y = length * across;
    const double angle = std::numbers::sqrt2 * std::atan2(y, x);
    const double z = std::hypot(x, y) / std::numbers::sqrt2;
    const double error = (ray.point - vec({z * std::cos(angle), z * std::sin(angle), z})).norm();
    EXPECT_LT(error, 1e-12);
    EXPECT_LT(error, ray.error + 1e-15);
  }
}

TEST(ExponentialMap, TurnsBothCirclesOfACliffordTorus) {
  const Surface torus = parse_surface("x^2+y^2=1; z^2+w^2=0.36");
  const ExponentialResult ray = exponential_map(torus, vec({1, 0, 0.6, 0}), vec({0, 0.6, 0, 0.8}), 25);
  const double a = 25 * 0.6;
  const double b = 25 * 0.8 / 0.6;
  EXPECT_LT((ray.point - vec({std::cos(a), std::sin(a), 0.6 * std::cos(b), 0.6 * std::sin(b)})).norm(), 1e-13);
  EXPECT_FALSE(ray.conjugate_at.has_value());
}

TEST(ExponentialMap, SphereInFourDimensionsWithASecondEquationIsTheSameSphere) {
  const Surface sphere = parse_surface("x^2+y^2+z^2=1; w=0");
  const ExponentialResult ray = exponential_map(sphere, vec({1, 0, 0, 0}), vec({0, 3, 4, 0}), 5);
  EXPECT_LT((ray.point - vec({std::cos(5), 0.6 * std::sin(5), 0.8 * std::sin(5), 0})).norm(), 1e-14);
  ASSERT_TRUE(ray.conjugate_at.has_value());
  EXPECT_NEAR(*ray.conjugate_at, kPi, 2e-15);
}

TEST(ExponentialMap, KeepsItsAccuracyWhereTheCurvatureJumps) {
  // A cylinder closed by half spheres: the Hessian jumps where they meet, at x = 1.
  const Surface capsule = parse_surface("max(abs(x)-1,0)^2+y^2+z^2=1");
  const ExponentialResult ray = exponential_map(capsule, vec({0, 0, 1}), vec({0.8, 0.6, 0}), 3);
  ASSERT_EQ(ray.status, Status::ok) << ray.reason;
  const double angle = 1.25 * 0.6;  // the helix meets x = 1 after 1.25
  const Vector at = vec({0, std::sin(angle), std::cos(angle)});
  const Vector along = vec({0.8, 0.6 * std::cos(angle), -0.6 * std::sin(angle)});
  const Vector end = vec({1, 0, 0}) + std::cos(1.75) * at + std::sin(1.75) * along;
  const double error = (ray.point - end).norm();
  EXPECT_LT(error, 1e-11);
  EXPECT_LT(error, ray.error);
}

TEST(ExponentialMap, KeepsClairautsConstant) {
  const Surface torus = test::torus(1, 0.4);
  const Vector p = vec({1.4, 0, 0});
  for (const double slope : {0.2, 1.0, 3.0}) {
    const ExponentialResult ray = exponential_map(torus, p, vec({0, 1, slope}), 30);
    const auto spin = [](const Vector& x, const Vector& v) { return x(0) * v(1) - x(1) * v(0); };
    const double before = 1.4 / std::hypot(1, slope);
    EXPECT_NEAR(spin(ray.point, ray.direction), before, 1e-13 + ray.error);
    EXPECT_NEAR(ray.direction.norm(), 1, 4e-16);
    EXPECT_LT(std::abs(torus.jacobian(ray.point).col(0).normalized().dot(ray.direction)), 1e-15);
  }
}

TEST(ExponentialMap, ComesBackAndDoesNotDependOnTheFormOfTheEquation) {
  const unsigned seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> axis(0.5, 2);
  for (int i = 0; i < 12; ++i) {
    const FormulaOptions options{.parameters = {{"a", axis(random)}, {"b", axis(random)}, {"c", axis(random)}}};
    const std::string f = "(x/a)^2+(y/b)^2+(z/c)^4-1";
    const Surface surface = parse_surface(f, options);
    const Vector v = random_vector(3, random);
    const ExponentialResult there = exponential_map(surface, random_vector(3, random), v, 5);
    ASSERT_EQ(there.status, Status::ok) << there.reason;
    const Vector p = there.points.col(0);
    const ExponentialResult back = exponential_map(surface, there.point, -there.direction, 5);
    const double unsure = there.error * there.amplification + back.error + 1e-15;
    EXPECT_LT((back.point - p).norm(), unsure);
    const ExponentialResult first = exponential_map(surface, p, v, 2);
    const ExponentialResult second = exponential_map(surface, first.point, first.direction, 3);
    EXPECT_LT((second.point - there.point).norm(), unsure);
    for (const std::string& form : {"3*(" + f + ")", "(" + f + ")+(" + f + ")^3"}) {
      const ExponentialResult same = exponential_map(parse_surface(form, options), p, v, 5);
      EXPECT_LT((same.point - there.point).norm(), there.error + same.error);
      EXPECT_EQ(same.conjugate_at.has_value(), there.conjugate_at.has_value());
    }
  }
}

TEST(ExponentialMap, ScalesWithTheModel) {
  const ExponentialResult one = exponential_map(test::ellipsoid(3, 2, 1), vec({3, 0, 0}), vec({0, 1, 1}), 9);
  for (const double scale : {1e-9, 1e7}) {
    const ExponentialResult other = exponential_map(test::ellipsoid(3 * scale, 2 * scale, scale),
                                                    vec({3 * scale, 0, 0}), vec({0, 1, 1}), 9 * scale);
    EXPECT_LT((other.point / scale - one.point).norm(), one.error + other.error / scale);
    EXPECT_NEAR(*other.conjugate_at / scale, *one.conjugate_at, 1e-13);
  }
}

TEST(ExponentialMap, PointsLieOnTheSurfaceInOrder) {
  const Surface surface = test::tangle_cube();
  const ExponentialResult ray = exponential_map(surface, vec({2, 1, 1}), vec({0, 1, 0.3}), 6);
  ASSERT_GT(ray.points.cols(), 50);
  EXPECT_EQ(ray.points.rightCols(1), ray.point);
  double length = 0;
  for (Index j = 0; j < ray.points.cols(); ++j) {
    EXPECT_LT(std::abs(surface.value(ray.points.col(j))(0)), 1e-13);
    if (j > 0) length += (ray.points.col(j) - ray.points.col(j - 1)).norm();
  }
  EXPECT_NEAR(length, 6, 6e-4);  // chords of at most a twentieth of a radian
}

TEST(ExponentialMap, StepsAreOfOrderSixteen) {
  const Surface surface = test::ellipsoid(3, 2, 1);
  const ExponentialResult start = exponential_map(surface, vec({1, 1, 1}), vec({1, -2, 0.5}), 0);
  const auto error = [&](double h) {
    detail::RayStep<3> step(surface);
    detail::RayStep<3>::State state{start.point, start.direction, {}, {}};
    (void)step.look(state);
    const detail::RayStep<3>::State from = state;
    EXPECT_EQ(step.attempt(from, h, 0), detail::RayStep<3>::Verdict::good);
    step.arrive(state);
    const double miss = (state.x - exponential_map(surface, start.point, start.direction, h).point).norm();
    EXPECT_LT(miss, 10 * (step.error_x + h * step.error_v) + 1e-15);
    return miss;
  };
  const double slope = std::log(error(1.6) / error(1.2)) / std::log(1.6 / 1.2);
  EXPECT_NEAR(slope, 17, 3);  // of one step: one more than of the method
}

TEST(ExponentialMap, StopsWhereTheDomainEnds) {
  const Surface half = parse_surface("x^2+y^2+z^2=1", {.domain = {"z>=0"}});
  const ExponentialResult over = exponential_map(half, vec({0, 0, 1}), vec({0, 2, 0}), 7);
  EXPECT_EQ(over.status, Status::left_domain);
  EXPECT_NEAR(over.length, kPi / 2, 1e-14);
  EXPECT_LT((over.point - vec({0, 1, 0})).norm(), 1e-14);
  const ExponentialResult along = exponential_map(half, vec({1, 0, 0}), vec({0, 1, 0}), 2);
  EXPECT_EQ(along.status, Status::ok);
  const ExponentialResult out = exponential_map(half, vec({1, 0, 0}), vec({0, 0, -1}), 2);
  EXPECT_EQ(out.status, Status::left_domain);
  EXPECT_LT(out.length, 1e-13);
  const ExponentialResult back = exponential_map(half, vec({0, 0, 1}), vec({0, 2, 0}), -7);
  EXPECT_NEAR(back.length, -kPi / 2, 1e-14);
  const ExponentialResult undefined = exponential_map(parse_surface("z=sqrt(x)"), vec({1, 0, 1}), vec({-1, 0.2, 0}), 7);
  EXPECT_EQ(undefined.status, Status::left_domain);
}

TEST(ExponentialMap, StopsAtSingularPointsAndCreases) {
  const ExponentialResult apex = exponential_map(parse_surface("x^2+y^2=z^2"), vec({1, 0, 1}), vec({-1, 0, -1}), 3);
  EXPECT_EQ(apex.status, Status::rank_deficient);
  EXPECT_NEAR(apex.length, std::numbers::sqrt2, 1e-13);
  for (const std::string crease : {"z=abs(x)", "z=1e-4*abs(x)"}) {
    const Surface surface = parse_surface(crease);
    const Vector p = project_to_surface(surface, vec({1, 0, 0.9})).point;
    const ExponentialResult ray = exponential_map(surface, p, vec({-1, 0, surface.jacobian(p)(0)}), 3);
    EXPECT_EQ(ray.status, Status::not_converged) << crease;
    EXPECT_NEAR(ray.point(0), 0, 1e-12);
  }
}

TEST(ExponentialMap, SaysWhenTheEndIsUnknowable) {
  // On the gyroid (K <= 0) rays spread by e^33 within 50.
  const Surface gyroid = parse_surface("sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)");
  const ExponentialResult ray = exponential_map(gyroid, vec({0, 0, 0}), vec({1, 0.2, -1}), 50);
  EXPECT_EQ(ray.status, Status::not_converged);
  EXPECT_GT(ray.error, 0.1);
  const ExponentialResult endless =
      exponential_map(test::unit_sphere(), vec({1, 0, 0}), vec({0, 1, 0}), 1e9, {.max_steps = 50});
  EXPECT_EQ(endless.status, Status::not_converged);
  EXPECT_EQ(endless.num_steps, 50);
  EXPECT_LT((endless.point - vec({std::cos(endless.length), std::sin(endless.length), 0})).norm(), 1e-13);
}

TEST(ExponentialMap, ZeroLengthIsTheStart) {
  const ExponentialResult ray = exponential_map(test::unit_sphere(), vec({2, 0, 0}), vec({1, 1, 0}), 0);
  EXPECT_EQ(ray.status, Status::ok);
  EXPECT_EQ(ray.point, vec({1, 0, 0}));
  EXPECT_EQ(ray.direction, vec({0, 1, 0}));
  EXPECT_FALSE(ray.conjugate_at.has_value());
}

TEST(ExponentialMap, RefusesWhatIsNoRay) {
  const Surface sphere = test::unit_sphere();
  const Vector p = vec({1, 0, 0});
  const Vector v = vec({0, 1, 0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)exponential_map(sphere, p, vec({0, 0, 0}), 1), InvalidArgument);
  EXPECT_THROW((void)exponential_map(sphere, p, vec({1, 0, 0}), 1), InvalidArgument);
  EXPECT_THROW((void)exponential_map(sphere, p, vec({nan, 0, 0}), 1), InvalidArgument);
  EXPECT_THROW((void)exponential_map(sphere, vec({1, 0}), v, 1), InvalidArgument);
  EXPECT_THROW((void)exponential_map(sphere, p, v, nan), InvalidArgument);
  EXPECT_THROW((void)exponential_map(sphere, vec({0, 0, 0}), v, 1), SingularPoint);
  EXPECT_THROW((void)exponential_map(sphere, p, v, 1, {.tolerance = 1}), InvalidArgument);
  EXPECT_THROW((void)exponential_map(sphere, p, v, 1, {.max_steps = 0}), InvalidArgument);
  const std::atomic<bool> cancelled = true;
  Context context;
  context.cancel = &cancelled;
  EXPECT_THROW((void)exponential_map(sphere, p, v, 1, {}, context), Cancelled);
}

}  // namespace
}  // namespace taut
