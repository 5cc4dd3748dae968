#include "taut/query/field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

TEST(MarchedField, IsTheAngleOnTheUnitSphere) {
  const FieldResult field = marched_field(test::unit_sphere(), Vector(Eigen::Vector3d::UnitX()));
  ASSERT_EQ(field.mesh.scalars.size(), 1U);
  const Vector& distance = field.mesh.scalars.front().values;
  ASSERT_EQ(distance.size(), field.mesh.vertices.cols());
  ASSERT_GT(distance.size(), 500);
  for (Index v = 0; v < distance.size(); ++v) {
    EXPECT_NEAR(distance(v), std::acos(std::min(1.0, field.mesh.vertices(0, v))), 0.02) << "vertex " << v;
  }
}

TEST(MarchedField, SeveralSourcesGiveTheNearest) {
  Points sources(3, 2);
  sources << 1, -1, 0, 0, 0, 0;
  const FieldResult field = marched_field(test::unit_sphere(), sources);
  EXPECT_LT(field.mesh.scalars.front().values.maxCoeff(), std::acos(0.0) + 0.02);
}

TEST(MarchedField, NeedsASource) {
  EXPECT_THROW((void)marched_field(test::unit_sphere(), Points(3, 0)), InvalidArgument);
}

TEST(MarchedField, RefusesMoreDimensionsThanCellsReach) {
  EXPECT_THROW((void)marched_field(test::unit_sphere(8), Vector(Vector::Unit(8, 0))), InvalidArgument);
}

}  // namespace
}  // namespace taut
