#include "taut/query/surface_summary.hpp"

#include <gtest/gtest.h>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(SurfaceSummary, FindsTheSphereAndItsOneComponent) {
  const SurfaceSummary summary = summarise(test::unit_sphere());
  EXPECT_EQ(summary.dim, 3);
  EXPECT_EQ(summary.codim, 1);
  ASSERT_EQ(summary.components.size(), 1U);
  EXPECT_EQ(summary.components.front(), summary.num_cells);
  EXPECT_TRUE((summary.box.lower.array() <= -1).all());
  EXPECT_TRUE((summary.box.upper.array() >= 1).all());
}

TEST(SurfaceSummary, CountsTwoSpheres) {
  const Surface two = parse_surface("(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0");
  EXPECT_EQ(summarise(two).components.size(), 2U);
}

TEST(SurfaceSummary, AnEmptySurfaceIsSaid) {
  EXPECT_THROW((void)summarise(parse_surface("x^2+y^2+z^2+1=0")), EmptySurface);
}

}  // namespace
}  // namespace taut
