// Formulas with kinks as pieces: the face that holds at a point has the value and the derivatives of the formula there.
#include "surface/formula/kinks.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "strata/faceted_surface.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using detail::FacetedSurface;
using detail::FormulaKinks;
using detail::Point3;

TEST(Kinks, SmoothFormulasHaveNone) { EXPECT_EQ(FormulaKinks::of(parse_surface("x^2+y^2+z^2=1").function()), nullptr); }

TEST(Kinks, TheFaceAtAPointIsTheFormulaThere) {
  for (const std::string formula :
       {"max(x^2+y^2-4, abs(z)-1)", "min(max(x,y-z),abs(x*y)-0.3)", "sqrt(max(abs(x)-1,0)^2+y^2+z^2)-0.5",
        "x*sign(x)+y^2-z", "max(x,y,z,-x,-y,-z)-1"}) {
    const Surface surface = parse_surface(formula);
    const auto faces = FacetedSurface::of(surface);
    ASSERT_NE(faces, nullptr) << formula;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> coordinate(-2, 2);
    for (int i = 0; i < 50; ++i) {
      const Point3 x(coordinate(random), coordinate(random), coordinate(random));
      Point3 gradient;
      const double value = faces->function(faces->face_at(x), x, gradient);
      EXPECT_NEAR(value, surface.value(x)(0), 1e-14) << formula;
      EXPECT_NEAR((gradient - surface.jacobian(x)).norm(), 0, 1e-13) << formula;
    }
  }
}

TEST(Kinks, ChoicesThatMeanTheSameAreOneFace) {
  // max(x, x) is x; and where the lid holds, the sign of z alone matters.
  const auto faces = FacetedSurface::of(parse_surface("max(x^2+y^2-4, abs(z)-1)"));
  EXPECT_EQ(faces->face_at(Point3(2, 0, 0.5)), faces->face_at(Point3(0, 2, -0.5)));
  EXPECT_NE(faces->face_at(Point3(0, 0, 1)), faces->face_at(Point3(0, 0, -1)));
}

TEST(Kinks, StarsKnowTheirAngles) {
  constexpr double kPi = 3.14159265358979323846;
  const auto cube = FacetedSurface::of(parse_surface("max(abs(x),abs(y),abs(z))-1"));
  const auto inside = cube->star(Point3(0.3, 0.2, 1), 1e-9);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->wedges.size(), 1U);
  // The diagonal of a face is no edge, though the branches of the maximum meet there.
  const auto diagonal = cube->star(Point3(0.3, 0.3, 1), 1e-9);
  ASSERT_TRUE(diagonal);
  EXPECT_EQ(diagonal->wedges.size(), 1U);
  const auto edge = cube->star(Point3(1, 0.2, 1), 1e-9);
  ASSERT_TRUE(edge);
  ASSERT_EQ(edge->wedges.size(), 2U);
  for (const auto& wedge : edge->wedges) EXPECT_NEAR(wedge.angle, kPi, 1e-12);
  const auto corner = cube->star(Point3(1, -1, 1), 1e-9);
  ASSERT_TRUE(corner);
  ASSERT_EQ(corner->wedges.size(), 3U);
  EXPECT_TRUE(corner->closed);
  for (const auto& wedge : corner->wedges) EXPECT_NEAR(wedge.angle, kPi / 2, 1e-12);
}

}  // namespace
}  // namespace taut
