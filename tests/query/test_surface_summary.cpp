#include "taut/query/surface_summary.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(SurfaceSummary, TellsAreaHandlesAndEnds) {
  const double pi = std::numbers::pi;
  struct Case {
    const char* formula;
    std::vector<std::string> domain;
    double area;
    Index euler;
    bool closed;
  };
  for (const Case& c :
       {Case{"x^2+y^2+z^2=1", {}, 4 * pi, 2, true},
        Case{"(x^2+y^2+z^2+0.84)^2=4*(x^2+y^2)", {}, 4 * pi * pi * 0.4, 0, true},
        Case{"x^2+y^2+z^2=1", {"z >= 0"}, 2 * pi, 1, false}, Case{"x^2+y^2+0z=1", {"0 <= z <= 2"}, 4 * pi, 0, false}}) {
    const SurfaceSummary summary = summarise(parse_surface(c.formula, {.domain = c.domain}));
    ASSERT_TRUE(summary.shape) << c.formula;
    EXPECT_NEAR(summary.shape->area, c.area, 0.02 * c.area) << c.formula;  // triangles of some 60 cells a length
    EXPECT_EQ(summary.shape->euler, c.euler) << c.formula;
    EXPECT_EQ(summary.shape->closed, c.closed) << c.formula;
    EXPECT_FALSE(summary.shape->cut_by_box) << c.formula;
  }
  EXPECT_TRUE(summarise(parse_surface("z = x*y")).shape->cut_by_box);
  EXPECT_FALSE(summarise(parse_surface("x^2+y^2=1")).shape);
}

// A bar with a slit of 0.04 along it: a ring, on fine cells only.
TEST(SurfaceSummary, CountsHandlesOnCellsThatAreFineEnough) {
  const Surface ring = parse_surface("(x/4)^8+(y/0.5)^8+(z/0.2)^8+1.3*exp(-((x/3.2)^8+(y/0.04)^2))=1");
  const SurfaceSummary summary = summarise(ring);
  ASSERT_TRUE(summary.shape);
  EXPECT_EQ(summary.shape->euler, 0);
  EXPECT_TRUE(summary.shape->settled);
  EXPECT_LT(summary.shape->cell, summary.cell);
  const SurfaceSummary asked = summarise(ring, {.cell = 0.3});
  EXPECT_EQ(asked.shape->cell, 0.3);
  EXPECT_FALSE(asked.shape->settled) << "one size tells nothing of finer ones";
}

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

TEST(SurfaceSummary, AboveSixDimensionsPatchesGrowFromSamples) {
  // Two spheres in R^7, seeds on one or on both of them.
  const Surface two =
      parse_surface("(x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2-1)*((x1-5)^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2-1)=0");
  SummaryOptions options{.cell = 0.9, .grid = GridMethod::grow, .seeds = Vector::Unit(7, 1)};
  const SurfaceSummary one = summarise(two, options);
  EXPECT_TRUE(one.counts.complete);
  EXPECT_EQ(one.components, std::vector<Index>{one.num_cells});
  EXPECT_EQ(one.counts.num_lookups, 14 * one.num_cells);
  EXPECT_LT(one.box.upper(0), 2);
  EXPECT_GE(one.box.upper(3), 1);
  options.seeds.resize(7, 2);
  options.seeds << Vector::Unit(7, 1), 6 * Vector::Unit(7, 0);
  const SurfaceSummary both = summarise(two, options);
  ASSERT_EQ(both.components.size(), 2U);
  EXPECT_GE(both.box.upper(0), 6);
  options.seeds.resize(7, 0);
  EXPECT_THROW((void)summarise(two, options), InvalidArgument);
  EXPECT_THROW((void)summarise(two, {.cell = 0.9}), InvalidArgument) << "there are no cells to be of that size";
}

TEST(SurfaceSummary, AnEmptySurfaceIsSaid) {
  EXPECT_THROW((void)summarise(parse_surface("x^2+y^2+z^2+1=0")), EmptySurface);
}

}  // namespace
}  // namespace taut
