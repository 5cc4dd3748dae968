#include "taut/curve/exponential_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/geodesic_start.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/newton.hpp"

namespace taut {
namespace {

TEST(Verify, TellsAnErrorAlongFromOneAcross) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(1, 0, 0);
  const auto end = [](double s, double aside) {
    return Vector(Eigen::Vector3d(std::cos(s), std::sin(s) * std::cos(aside), std::sin(s) * std::sin(aside)));
  };
  const Vector v = Eigen::Vector3d(0, 1, 0);
  const Verification right = verify_geodesic(sphere, p, v, 1, end(1, 0));
  EXPECT_EQ(right.status, Status::ok);
  EXPECT_LT(right.miss, 1e-15);
  EXPECT_LT(right.miss, right.error);
  const Verification longer = verify_geodesic(sphere, p, v, 1, end(1 + 1e-6, 0));
  EXPECT_NEAR(longer.miss, 1e-6, 1e-12);
  EXPECT_NEAR(longer.miss_along, 1e-6, 1e-12);
  const Verification aside = verify_geodesic(sphere, p, v, 1, end(1, 1e-6));
  EXPECT_NEAR(aside.miss, 1e-6 * std::sin(1), 1e-12);
  EXPECT_NEAR(aside.miss_along, 0, 1e-12);
  EXPECT_THROW((void)verify_geodesic(sphere, p, v, 1, Vector(Eigen::Vector2d(0, 1))), InvalidArgument);
}

TEST(Verify, ConfirmsNewtonsPaths) {
  for (const Surface& surface : {test::ellipsoid(3, 2, 1), test::torus(), test::tangle_cube()}) {
    const double x = surface.dim() == 3 && surface.value(Vector(Eigen::Vector3d(3, 0, 0)))(0) == 0 ? 3 : 1.4;
    Vector p = Eigen::Vector3d(x, 0.3, 0.2);
    for (int i = 0; i < 8; ++i) {
      const Vector g = surface.jacobian(p);
      p -= surface.value(p)(0) / g.squaredNorm() * g;
    }
    const Vector g = surface.jacobian(p);
    Vector v = Eigen::Vector3d(0, 1, 0.5);
    v = (v - g * (g.dot(v) / g.squaredNorm())).normalized();
    const Points start = test::integrate_geodesic(surface, p, v, 1.2, 20);
    const NewtonResult path = correct_newton(surface, start, {.tolerance = 1e-13});
    ASSERT_EQ(path.status, Status::ok) << path.reason;
    const Verification found = verify_geodesic(surface, p, path.start_direction, path.length, start.rightCols(1));
    EXPECT_EQ(found.status, Status::ok);
    EXPECT_LT(found.miss, 1e-6);
    EXPECT_LT(std::abs(found.miss_along), path.length_error + found.error + 10 * found.miss * found.miss + 1e-14);
  }
}

}  // namespace
}  // namespace taut
