// Bodies as functions in formulas, against values that are plain geometry.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

double at(const std::string& formula, double x, double y, double z) {
  return parse_surface(formula).value(Eigen::Vector3d(x, y, z))(0);
}

std::string error_of(const std::string& formula, const FormulaOptions& options = {}) {
  try {
    (void)parse_surface(formula, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Solids, PrimitivesAreDistancesWhereTheyAreRound) {
  EXPECT_DOUBLE_EQ(at("sphere(1, 2, 3, 0.5)", 1, 2, 5), 1.5);
  EXPECT_DOUBLE_EQ(at("box(0, 0, 0, 2, 4, 6)", 1.5, 0, 0), 0.5);
  EXPECT_DOUBLE_EQ(at("box(0, 0, 0, 2, 4, 6)", 0, 1, -2), -1);
  EXPECT_DOUBLE_EQ(at("cylinder(0, 0, 1, 0.5, 2)", 0, 2, 1), 1.5);
  EXPECT_DOUBLE_EQ(at("cylinder(0, 0, 1, 0.5, 2)", 0, 0, 2.25), 0.25);
  EXPECT_DOUBLE_EQ(at("torus(0, 0, 0, 2, 0.5)", 0, 2, 1), 0.5);
  EXPECT_DOUBLE_EQ(at("plane(0, 3, 4, 10)", 0, 0, 0), -2);
  EXPECT_DOUBLE_EQ(at("capsule(0, 0, 0, 0, 0, 2, 0.5)", 3, 0, 1), 2.5);
  EXPECT_DOUBLE_EQ(at("capsule(0, 0, 0, 0, 0, 2, 0.5)", 3, 0, 6), 4.5);
  // A cone of radius and height 1: the distance of a point beside its flank, and below its base.
  EXPECT_NEAR(at("cone(0, 0, 0, 1, 1)", 1, 0, 1), std::sqrt(0.5), 1e-15);
  EXPECT_DOUBLE_EQ(at("cone(0, 0, 0, 1, 1)", 0, 0, -0.5), 0.5);
  EXPECT_NEAR(at("cone(1, 1, 1, 1, 2)", 1.5, 1, 2), 0, 1e-15);
}

TEST(Solids, OperationsAreThoseOfSets) {
  const std::string a = "sphere(0,0,0,1)";
  const std::string b = "sphere(1,0,0,1)";
  EXPECT_LT(at("union(" + a + "," + b + ")", 1.5, 0, 0), 0);
  EXPECT_GT(at("intersection(" + a + "," + b + ")", 1.5, 0, 0), 0);
  EXPECT_LT(at("intersection(" + a + "," + b + ")", 0.5, 0, 0), 0);
  EXPECT_LT(at("difference(" + a + "," + b + ")", -0.5, 0, 0), 0);
  EXPECT_GT(at("difference(" + a + "," + b + ")", 0.5, 0, 0), 0);
  EXPECT_EQ(at("union(" + a + "," + b + "," + "sphere(9,0,0,1))", 9, 0, 0), -1);
  EXPECT_EQ(at("difference(" + a + "," + b + "," + "sphere(-1,0,0,1))", -0.5, 0, 0), 0.5);
}

/// Two walls at right angles joined with radius r: the surface passes at a distance of r / sqrt(2) from either on the
/// diagonal (x y = r^2 / 2), with least radius of curvature r, and comes near to the walls by r^2 / (2 D).
TEST(Solids, SmoothOperationsHaveTheirRadius) {
  const std::string wall = "smooth_union(plane(1,0,0,0), plane(0,1,0,0), 0.2)";
  EXPECT_NEAR(at(wall, 0.2 / std::sqrt(2), 0.2 / std::sqrt(2), 0), 0, 1e-15);
  const Surface surface = parse_surface(wall);
  const Eigen::Vector3d p(0.2 / std::sqrt(2), 0.2 / std::sqrt(2), 0);
  const Eigen::Vector3d gradient = surface.jacobian(p);
  const Eigen::Vector3d along = Eigen::Vector3d(1, -1, 0).normalized();
  const double curvature = along.dot(surface.hessian(p, Vector::Ones(1)) * along) / gradient.norm();
  EXPECT_NEAR(std::abs(curvature), 1 / 0.2, 1e-12);
  EXPECT_NEAR(at(wall, 0, 5, 0), -0.2 * 0.2 / (2 * 5), 1e-5);
  EXPECT_NEAR(at("smooth_intersection(plane(1,0,0,0), plane(0,1,0,0), 0.2)", 0, -5, 0), 0.2 * 0.2 / 10, 1e-5);
  EXPECT_NEAR(at("smooth_difference(plane(1,0,0,0), plane(0,1,0,0), 0.2)", 0, 5, 0), 0.2 * 0.2 / 10, 1e-5);
}

TEST(Solids, TransformsMoveBodies) {
  EXPECT_DOUBLE_EQ(at("translate(sphere(0,0,0,1), 1, 2, 3)", 1, 2, 5), 1);
  EXPECT_DOUBLE_EQ(at("scale(sphere(1,0,0,1), 2)", 5, 0, 0), 1);
  EXPECT_NEAR(at("scale(sphere(0,0,0,1), 1, 2, 3)", 0, 0, 3), 0, 1e-15);
  // A quarter turn round z takes x to y, exactly.
  EXPECT_EQ(at("rotate(box(0,0,0,4,2,2), 0,0,1, pi/2)", 0, 2, 0), 0);
  EXPECT_EQ(at("rotate(box(0,0,0,4,2,2), 0,0,1, pi/2)", 2, 0, 0), 1);
  // Round the diagonal by a third: x to y to z.
  EXPECT_NEAR(at("rotate(sphere(1,0,0,0.5), 1,1,1, 2*pi/3)", 0, 1, 0), -0.5, 1e-15);
  EXPECT_NEAR(at("rotate(sphere(1,0,0,0.5), 1,1,1, 2*pi/3)", 0, 0, 1), std::sqrt(2) - 0.5, 1e-15);
  // Any expression is a body, its powers, too.
  EXPECT_DOUBLE_EQ(at("translate(x^3 + y^2 - z, 1, 0, 0)", 3, 1, 2), 7);
  EXPECT_DOUBLE_EQ(at("translate(rotate(translate(sphere(0,0,0,1), 2,0,0), 0,0,1,pi), 0,0,1)", -2, 0, 1), -1);
}

TEST(Solids, DerivativesAndBoundsAreThoseOfFormulas) {
  const Surface surface = parse_surface(
      "smooth_union(rotate(torus(0,0,0,1,0.3), 1,2,0,0.7), translate(sphere(0,0,0,0.6),0.9,0.2,0), "
      "scale(sphere(0,0,0,0.5),1,2,1), 0.1)");
  const Box box{Eigen::Vector3d(-1.4, -1.3, -1.2), Eigen::Vector3d(1.5, 1.1, 1.3)};
  EXPECT_TRUE(check_conformance(surface.function(), box).ok()) << check_conformance(surface.function(), box).text();
}

TEST(Solids, MistakesAreNamed) {
  EXPECT_NE(error_of("sphere(0,0,1)").find("sphere(x, y, z, r)"), std::string::npos);
  EXPECT_NE(error_of("sphere(0,0,0,-1)").find("argument 4 must be above 0"), std::string::npos);
  EXPECT_NE(error_of("smooth_union(sphere(0,0,0,1), sphere(1,0,0,1), 0)").find("argument 3"), std::string::npos);
  EXPECT_NE(error_of("spheer(0,0,0,1)").find("sphere"), std::string::npos);
  EXPECT_NE(error_of("sphere(0,0,0,1", {}).find("never closed"), std::string::npos);
  EXPECT_NE(error_of("sphere(0,0,0,1)", {.dim = 2}).find("3 dimensions"), std::string::npos);
  EXPECT_NE(error_of("scale(x,1,2)").find("scale("), std::string::npos);
  // A parameter may have the name of a body.
  EXPECT_EQ(error_of("x^2+y^2=box", {.parameters = {{"box", 2}}}), "");
}

TEST(SceneText, DefinitionsOneALine) {
  const Surface scene = parse_scene(
      "# a bracket\n"
      "r = 0.25   // fillets\n"
      "base = box(0, 0, 0,\n"
      "           4, 2, 0.4)\n"
      "\n"
      "post = cylinder(0, 0, 1, 0.5, 2)\n"
      "smooth_union(base, post, r) = 0\n");
  const Surface same = parse_surface("smooth_union(box(0,0,0,4,2,0.4), cylinder(0,0,1,0.5,2), 0.25)");
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 0.3, 0.2), Eigen::Vector3d(0.4, -0.4, 1.7)}) {
    EXPECT_EQ(scene.value(p), same.value(p));
  }
  EXPECT_EQ(scene.dim(), 3);
  // A number given from outside comes first.
  EXPECT_EQ(parse_scene("r = 1\nsphere(0,0,0,r)", {.parameters = {{"r", 2}}}).value(Eigen::Vector3d(0, 0, 0))(0), -2);
}

TEST(SceneText, MistakesNameTheirLine) {
  const auto error = [](const std::string& text) -> std::string {
    try {
      (void)parse_scene(text);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error("a = sphere(0,0,0,1)\n\nb = bax\nunion(a,b)").find("line 3"), std::string::npos);
  EXPECT_NE(error("sphere(0,0,0,1)\nsphere(1,0,0,1)").find("line 1: only the last line"), std::string::npos);
  EXPECT_NE(error("x = sphere(0,0,0,1)\nx").find("line 1"), std::string::npos);
  EXPECT_NE(error("a = 1\na = 2\nx+a").find("defined twice"), std::string::npos);
  EXPECT_NE(error("# nothing\n").find("empty"), std::string::npos);
}

}  // namespace
}  // namespace taut
