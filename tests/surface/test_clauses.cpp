// Clause files (.vm): read into the graph of formulas.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTangleCube = R"(# a closed form
_x var-x
_y var-y
_z var-z
_x2 square _x
_x4 square _x2
_y2 square _y
_y4 square _y2
_z2 square _z
_z4 square _z2
_5 const 5.0
_a mul _x2 _5
_b mul _y2 _5
_c mul _z2 _5
_s0 sub _x4 _a
_s1 add _s0 _y4
_s2 sub _s1 _b

_s3 add _s2 _z4   # the rest
_s4 sub _s3 _c
_10 const 1e1
_out add _s4 _10
)";

std::string error_of(const std::string& clauses) {
  try {
    static_cast<void>(parse_clauses(clauses));
  } catch (const ParseError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

Points random_points(Index dim, double half) {
  Points x(dim, 50);
  std::mt19937 random(1);
  for (double& entry : x.reshaped()) entry = half * (static_cast<double>(random()) * 0x1p-31 - 1);
  return x;
}

TEST(Clauses, AreTheFormulaTheySpell) {
  const Surface clauses = parse_clauses(kTangleCube);
  const Surface formula = parse_surface("x^4-5x^2+y^4-5y^2+z^4-5z^2+10");
  const Points x = random_points(3, 3);
  EXPECT_TRUE(clauses.value(x).isApprox(formula.value(x), 1e-13));
  EXPECT_TRUE(clauses.jacobian(x).isApprox(formula.jacobian(x), 1e-13));
  const ConformanceReport report =
      check_conformance(clauses.function(), {Vector::Constant(3, -2), Vector::Constant(3, 2)});
  EXPECT_TRUE(report.ok()) << report.text();
}

TEST(Clauses, EveryOperation) {
  const std::string clauses =
      "x var-x\ny var-y\nc const -0.25\na abs x\nb sqrt a\nd exp y\ne ln d\nf sin x\ng cos y\nh tan c\ni asin f\n"
      "j acos g\nk atan y\nl recip d\nm min b e\nn max f g\no atan2 h i\np div j d\nq pow d c\nr neg k\ns sub l m\n"
      "t add n o\nu mul p q\nv add r s\nw add t u\nout add v w\n";
  const Surface surface = parse_clauses(clauses);
  const Surface formula = parse_surface(
      "-atan(y) + (1/exp(y) - min(sqrt(abs(x)), log(exp(y)))) + (max(sin(x), cos(y)) + atan2(tan(-0.25), "
      "asin(sin(x)))) + "
      "acos(cos(y))/exp(y)*exp(y)^(-0.25)");
  const Points x = random_points(2, 1.4);
  EXPECT_TRUE(surface.value(x).isApprox(formula.value(x), 1e-13));
}

TEST(Clauses, DimensionsAndDomain) {
  EXPECT_EQ(parse_clauses("x var-x\n").dim(), 2);
  EXPECT_EQ(parse_clauses("x var-x\n", {.dim = 3}).dim(), 3);
  EXPECT_EQ(parse_clauses("z var-z\n").dim(), 3);
  EXPECT_THROW((void)parse_clauses("z var-z\n", {.dim = 2}), InvalidArgument);
  const Surface cut = parse_clauses("x var-x\n", {.parameters = {{"a", 2}}, .domain = {"y <= a"}});
  EXPECT_TRUE(cut.inside_domain(Vector::Constant(2, 1))(0));
  EXPECT_FALSE(cut.inside_domain(Vector::Constant(2, 3))(0));
}

TEST(Clauses, BadOnesAreNamedByTheirLine) {
  EXPECT_THAT(error_of(""), HasSubstr("there is no clause"));
  EXPECT_THAT(error_of("# only\n\n# comments\n"), HasSubstr("there is no clause"));
  EXPECT_THAT(error_of("x var-x\n\ny add x\n"), HasSubstr("line 3: 'add' takes 2 operands, not 1"));
  EXPECT_THAT(error_of("x var-x\ny neg z\n"), HasSubstr("line 2: no clause before it is named 'z'"));
  EXPECT_THAT(error_of("x neg x\n"), HasSubstr("no clause before it is named 'x'"));
  EXPECT_THAT(error_of("x var-x\nx var-y\n"), HasSubstr("line 2: 'x' is named twice"));
  EXPECT_THAT(error_of("x var-q\n"), HasSubstr("the variables are x, y and z"));
  EXPECT_THAT(error_of("x const 1,5\n"), HasSubstr("'1,5' is no finite number"));
  EXPECT_THAT(error_of("x const nan\n"), HasSubstr("no finite number"));
  EXPECT_THAT(error_of("x var-x\ny floor x\n"), HasSubstr("'floor' jumps"));
  EXPECT_THAT(error_of("x var-x\ny frob x\n"), HasSubstr("there is no operation 'frob'"));
  EXPECT_THAT(error_of("x\n"), HasSubstr("a clause is a name, an operation"));
  EXPECT_THAT(error_of("x const 1\n"), HasSubstr("constant"));
}

}  // namespace
}  // namespace taut
