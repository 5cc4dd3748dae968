#include "taut/surface/curvature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

TEST(Curvature, OfTheTorusIsItsClosedForm) {
  const double r = 0.4;
  const Surface torus = test::torus(1, r);
  for (const double theta : {0.0, 0.7, 2.5}) {
    const double rho = 1 + r * std::cos(theta);
    const SurfaceCurvature at = curvature_at(torus, Eigen::Vector3d(rho, 0, r * std::sin(theta)));
    const double along = std::cos(theta) / rho;  // round the axis
    EXPECT_NEAR(at.principal(0), 1 / r, 1e-12);
    EXPECT_NEAR(at.principal(1), along, 1e-12);
    EXPECT_NEAR(at.gaussian, along / r, 1e-12);
    EXPECT_NEAR(at.mean, (1 / r + along) / 2, 1e-12);
    EXPECT_NEAR(std::abs(at.directions(1, 1)), 1, 1e-12);
    EXPECT_LT(std::abs(at.normal.dot(at.directions.col(0))), 1e-14);
    EXPECT_NEAR(at.normal(0), std::cos(theta), 1e-12);
  }
}

TEST(Curvature, OfSpheresIsPositiveInAnyDimension) {
  for (const Index d : {2, 3, 7}) {
    const SurfaceCurvature at = curvature_at(test::unit_sphere(d), Vector(1.3 * Vector::Unit(d, 1)));
    EXPECT_LT((at.point - Vector::Unit(d, 1)).norm(), 1e-14);
    EXPECT_LT((at.principal.array() - 1).abs().maxCoeff(), 1e-13);
    EXPECT_NEAR(at.gaussian, 1, 1e-12);
  }
}

TEST(Curvature, RefusesWrongRequests) {
  EXPECT_THROW((void)curvature_at(test::unit_sphere(), Vector::Zero(2)), InvalidArgument);
  EXPECT_THROW((void)curvature_at(test::unit_sphere(), Vector::Constant(3, std::nan(""))), InvalidArgument);
}

}  // namespace
}  // namespace taut
