#include "taut/surface/surface.hpp"

#include <gtest/gtest.h>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

TEST(Surface, RefusesAMissingFunctionAndWrongDimensions) {
  EXPECT_THROW(Surface(nullptr), InvalidArgument);
  EXPECT_THROW(test::unit_sphere(3).with_box({Vector::Zero(2), Vector::Ones(2)}), InvalidArgument);
  EXPECT_THROW(test::unit_sphere(3).with_box({Vector::Zero(3), Vector::Ones(2)}), InvalidArgument);
  EXPECT_THROW(test::unit_sphere(3).with_box({Vector::Ones(3), Vector::Zero(3)}), InvalidArgument);
  EXPECT_THROW((void)test::unit_sphere(3).value(Points::Zero(4, 1)), InvalidArgument);
}

TEST(Surface, DomainCutsWhereAComponentIsNegative) {
  // The unit sphere kept where another "sphere function" of radius 0.5 is >= 0: everything with |x| >= 0.5.
  SurfaceExtras extras;
  extras.domain = std::make_shared<test::ScalarFunction<test::EllipsoidFunction>>(
      test::EllipsoidFunction{Vector::Constant(3, 0.5)});
  const Surface sphere = test::make_surface(test::EllipsoidFunction{Vector::Ones(3)}, extras);
  Points x(3, 2);
  x << 1, 0.1, 0, 0, 0, 0;
  const auto inside = sphere.inside_domain(x);
  EXPECT_TRUE(inside(0));
  EXPECT_FALSE(inside(1));
}

TEST(Surface, TakesABlockOfALargerMatrix) {
  SurfaceExtras extras;
  extras.domain = std::make_shared<test::ScalarFunction<test::EllipsoidFunction>>(
      test::EllipsoidFunction{Vector::Constant(3, 0.5)});
  const Surface sphere = test::make_surface(test::EllipsoidFunction{Vector::Ones(3)}, extras);
  const Points larger = Points::Random(5, 7);
  const Points points = larger.topRows(3);
  EXPECT_EQ(sphere.value(larger.topRows(3)), sphere.value(points));
  EXPECT_EQ(sphere.jacobian(larger.topRows(3)), sphere.jacobian(points));
  EXPECT_TRUE((sphere.inside_domain(larger.topRows(3)) == sphere.inside_domain(points)).all());
}

}  // namespace
}  // namespace taut
