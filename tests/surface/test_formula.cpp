#include "taut/surface/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

/// Value of a one-component formula at one point.
double at(const std::string& formula, const std::vector<double>& x, const FormulaOptions& options = {}) {
  const auto function = parse_function(formula, options);
  EXPECT_EQ(function->dim(), static_cast<Index>(x.size())) << formula;
  double value = 0;
  function->make_evaluator()->evaluate({.n = 1, .x = x.data(), .value = &value});
  return value;
}

Vector gradient(const std::string& formula, const std::vector<double>& x) {
  const auto function = parse_function(formula);
  Vector result(function->dim());
  function->make_evaluator()->evaluate({.n = 1, .x = x.data(), .jacobian = result.data()});
  return result;
}

/// The text of the error `formula` ends in.
std::string error_of(const std::string& formula, const FormulaOptions& options = {}) {
  try {
    (void)parse_surface(formula, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Formula, GrammarReadsAsMathematics) {
  const std::vector<double> p{2, 3};
  EXPECT_EQ(at("x + y*x^2", p), 14);
  EXPECT_EQ(at("-x^2 + y", p), -1);
  EXPECT_EQ(at("2^-1*x + 0*y", p), 1);
  EXPECT_EQ(at("2^x^y", p), 256);
  EXPECT_EQ(at("x - y - 1", p), -2);
  EXPECT_EQ(at("x / y / 2", p), 2.0 / 3 / 2);
  EXPECT_EQ(at("4y^2", p), 36);
  EXPECT_EQ(at("2(x+1)(y-1)", p), 12);
  EXPECT_EQ(at("x^2y", p), 12);
  EXPECT_EQ(at("- -x + +y", p), 5);
  EXPECT_EQ(at("x*-y", p), -6);
  EXPECT_EQ(at("x = y", p), -1);
  EXPECT_EQ(at("1.5e1x + .5y", p), 31.5);
  EXPECT_EQ(at("2e-1x + 0y", p), 0.4);
  EXPECT_DOUBLE_EQ(at("2e + x + 0y", p), 2 * std::numbers::e + 2);
  EXPECT_EQ(at("pow(x, y) + max(x, y, 7) - min(x, y)", p), 13);
  EXPECT_EQ(at("x\t+\ny", p), 5);
  EXPECT_EQ(at("r*x + y", p, {.parameters = {{"r", -0.5}}}), 2);
}

TEST(Formula, ReadsWhatPeopleType) {
  const std::vector<double> p{2, 3};
  EXPECT_EQ(at("x**2 + y", p), 7);
  EXPECT_EQ(at("x == y", p), -1);
  EXPECT_EQ(at("x\u00B2 + y\u00B3", p), 31);
  EXPECT_EQ(at("x\u00B9\u2070 - y", p), 1021);
  EXPECT_EQ(at("x\u207B\u00B9 + 0y", p), 0.5);
  EXPECT_EQ(at("-x\u00B2y", p), -12);
  EXPECT_EQ(at("2^x\u00B2 + 0y", p), 16);
  EXPECT_EQ(at("(x+y)\u00B2", p), 25);
  EXPECT_EQ(at("x\u2212y \u2013 1", p), -2);
  EXPECT_EQ(at("x\u00B7y + x\u00D7y + x\u22C5y", p), 18);
  EXPECT_EQ(at("y\u00F7x", p), 1.5);
  EXPECT_EQ(at("2\u03C0 + 0x + 0y", p), 2 * std::numbers::pi);
  EXPECT_EQ(at("\u221A(x+y-1) + \u221A4", p), 4);
  EXPECT_EQ(at("\uFEFFx\u00A0+\u2009y", p), 5);
  EXPECT_EQ(at("ln(x) - log(x) + arctan(y) - atan(y)", p), 0);
  EXPECT_EQ(at("|x-y| + |y|", p), 4);
  EXPECT_EQ(at("||x|-|y||", p), 1);
  EXPECT_EQ(at("2|x-y|\u00B2 - |-x|^2", p), -2);
  EXPECT_EQ(at("max(|x|, |y|)", p), 3);
  EXPECT_EQ(at("x y + xy + 2xy + xxy", p), 6 + 6 + 12 + 12);
  EXPECT_EQ(at("xy\u00B2", p), 18);
  EXPECT_EQ(at("x(y+1) + (y)(x)", p), 14);
  EXPECT_EQ(at("x1x2 + x2x1^2", p), 6 + 12);
  EXPECT_EQ(at("sin x", p), at("sin(x)", p));
  EXPECT_EQ(at("2 sin x cos y - 3*sin 2", p), at("2*sin(x)*cos(y) - 3*sin(2)", p));
  EXPECT_EQ(at("x sin y", p), at("x*sin(y)", p));
  EXPECT_EQ(at("sin^2(x) + cos\u00B2(x) + sin^2 y + cos\u00B2 y", p), at("sin(x)^2+cos(x)^2+sin(y)^2+cos(y)^2", p));
  EXPECT_EQ(at("R x + y", p, {.parameters = {{"R", 5}}}), 13);
}

TEST(Formula, VariablesMayHaveNamesOfTheirOwn) {
  const std::vector<double> p{2, 3};
  EXPECT_EQ(at("theta^2 + phi", p, {.variables = {"theta", "phi"}}), 7);
  EXPECT_EQ(at("\u03B8\u00B2 + 2\u03C6 + a", p, {.variables = {"\u03B8", "\u03C6"}, .parameters = {{"a", 1}}}), 11);
  EXPECT_EQ(at("y - x", p, {.variables = {"y", "x"}}), -1);  // the order given, not the alphabet's
  EXPECT_EQ(parse_surface("a = b", {.variables = {"a", "b", "c"}, .domain = {"c >= 0"}}).dim(), 3);
  const auto refused = [](const std::string& formula, const FormulaOptions& options) {
    return error_of(formula, options);
  };
  EXPECT_NE(refused("x = 1", {.variables = {"a", "b"}}).find("'x' is unknown"), std::string::npos);
  EXPECT_NE(refused("thta = 1", {.variables = {"theta", "phi"}}).find("did you mean 'theta'"), std::string::npos);
  EXPECT_NE(refused("a = 1", {.variables = {"a", "a"}}).find("twice"), std::string::npos);
  EXPECT_NE(refused("a = 1", {.variables = {"a", "sin"}}).find("function"), std::string::npos);
  EXPECT_NE(refused("a = 1", {.variables = {"a", "2b"}}).find("not a name"), std::string::npos);
  EXPECT_NE(refused("a = 1", {.dim = 3, .variables = {"a", "b"}}).find("dimension is 3"), std::string::npos);
  EXPECT_NE(refused("a = 1", {.variables = {"a", "b"}, .parameters = {{"a", 1}}}).find("variable"), std::string::npos);
}

TEST(Formula, AnUnknownNameIsToldByItsName) {
  try {
    (void)parse_surface("x^2 + y^2 = R^2");
    ADD_FAILURE() << "R has no value";
  } catch (const UnknownName& error) {
    EXPECT_EQ(error.name(), "R");
    EXPECT_EQ(error.column(), 12U);
  }
}

TEST(Formula, OfSeveralLinesTheErrorShowsOne) {
  const std::string what = error_of("x^2 +\n y^2 + q\n = 1");
  EXPECT_NE(what.find("\n   y^2 + q\n"), std::string::npos) << what;
  EXPECT_EQ(what.substr(what.rfind('\n') + 1), "         ^") << what;
}

TEST(Formula, DimensionIsTheLargestVariable) {
  EXPECT_EQ(parse_surface("x^2 = 1").dim(), 2);
  EXPECT_EQ(parse_surface("z = 1").dim(), 3);
  EXPECT_EQ(parse_surface("w^2 = x").dim(), 4);
  EXPECT_EQ(parse_surface("x50 = x1").dim(), 50);
  EXPECT_EQ(parse_surface("x^2 = 1", {.dim = 5}).dim(), 5);
  const Surface surface = parse_surface("x^2+y^2=1; z=w");
  EXPECT_EQ(surface.dim(), 4);
  EXPECT_EQ(surface.codim(), 2);
  EXPECT_EQ(surface.kind(), "formula");
}

TEST(Formula, DomainIsWhatMustNotBeNegative) {
  const Surface surface = parse_surface("x^2+y^2+z^2=1", {.domain = {"z >= 0.5", "0 <= y < 2; x < 1"}});
  ASSERT_NE(surface.domain(), nullptr);
  ASSERT_EQ(surface.domain()->codim(), 4);
  const Eigen::Vector3d p(0.25, 0.75, 2);
  Eigen::Vector4d value;
  surface.domain()->make_evaluator()->evaluate({.n = 1, .x = p.data(), .value = value.data()});
  EXPECT_EQ(value, Eigen::Vector4d(1.5, 0.75, 1.25, 0.75));
}

TEST(Formula, ErrorsPointAtTheColumn) {
  struct Case {
    std::string formula;
    std::size_t column;
    std::string reason;
  };
  const Case cases[] = {
      {"", 0, "empty"},
      {"  ", 0, "empty"},
      {"x +", 3, "missing"},
      {"x + )", 4, "missing"},
      {"()", 1, "nothing between"},
      {"(x", 0, "never closed"},
      {"x + sin((y)", 4, "never closed"},
      {"x)", 1, "closes nothing"},
      {"2 3x", 2, "operator"},
      {"1/2x", 3, "two ways"},
      {"1/xy", 3, "two ways"},
      {"x^yz", 3, "two ways"},
      {"2^x(y+1)", 3, "two ways"},
      {"2^-xy", 4, "two ways"},
      {"e(x) + y", 0, "write exp(...)"},
      {"sin x^2", 5, "two ways"},
      {"sin x y", 6, "two ways"},
      {"sin xy", 5, "two ways"},
      {"sin 2x", 5, "two ways"},
      {"sin x/2", 5, "two ways"},
      {"sin sin x", 0, "parentheses"},
      {"max x", 0, "parentheses"},
      {"sin -x", 0, "parentheses"},
      {"sin^-1(x)", 3, "whole power"},
      {"x\u00B2^3", 3, "two powers"},
      {"x\u207B", 1, "raised minus"},
      {"|x", 0, "never closed"},
      {"(|x)", 1, "never closed"},
      {"|x|x|+1|", 3, "operator"},
      {"|x|y", 3, "operator"},
      {"x = y = 1", 6, "second '='"},
      {"atan2(x)", 0, "2 arguments"},
      {"sqrt(x, y)", 0, "1 argument"},
      {"x, y", 1, "','"},
      {"x = y = z", 6, "second '='"},
      {"x;;y", 2, "nothing before"},
      {"z >= 0", 2, "domain"},
      {"x + 1e400", 4, "range"},
      {"x + 1.2.3", 7, "decimal points"},
      {"1 = 0", 0, "no variable"},
      {"x = 1; 2 = 2", 7, "no variable"},
      {"x^0 = 1", 0, "no variable"},
      {"sqrt(-1) + x", 0, "not a number"},
      {"x + 1/0", 5, "infinite"},
      {"x + x1", 4, "mixed"},
      {"x0", 0, "x1"},
      {"x01", 0, "leading zeros"},
      {"x99999999999999999999", 0, "largest dimension"},
      {"x + foo", 4, "'foo' is unknown"},
      {"Sin(x)", 0, "did you mean 'sin'"},
      {"x # y", 2, "means nothing"},
      {"x \x01", 2, "means nothing"},
      {"\\frac{x}{2}", 0, "LaTeX"},
      {"x\u2081 + y", 1, "lowered"},
      {"\U0001D465 + y", 0, "plain letter"},
      {"\u0445 + y", 0, "looks like x"},
      {"foo(x)", 0, "functions: sqrt"},
      {"cot(x)", 0, "1/tan(t)"},
  };
  for (const Case& c : cases) {
    try {
      (void)parse_surface(c.formula);
      ADD_FAILURE() << c.formula << " was accepted";
    } catch (const ParseError& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.column(), c.column) << what;
      EXPECT_NE(what.find(c.reason), std::string::npos) << what;
      EXPECT_EQ(std::count(what.begin(), what.end(), '\n'), 2) << what;
      EXPECT_EQ(what.back(), '^') << what;
    }
  }
}

TEST(Formula, CaretStandsUnderTheColumnInAWindowOfLongFormulas) {
  std::string formula(5000, ' ');
  for (std::size_t i = 0; i + 1 < formula.size(); i += 2) formula.replace(i, 2, "x+");
  const std::string what = error_of(formula + "q");
  const std::size_t first = what.find('\n');
  const std::size_t second = what.find('\n', first + 1);
  const std::string line = what.substr(first + 1, second - first - 1);
  EXPECT_LT(line.size(), 120u);
  EXPECT_EQ(line[what.size() - second - 2], 'q') << what;
  // A character of two bytes before the column does not move the caret.
  const std::string utf8 = error_of("\xCF\x80 $");
  EXPECT_EQ(utf8.substr(utf8.rfind('\n') + 1), "    ^");
}

TEST(Formula, ParametersShadowNothing) {
  EXPECT_NE(error_of("x = a", {.parameters = {{"a", kNaN}}}).find("finite"), std::string::npos);
  EXPECT_NE(error_of("x = a", {.parameters = {{"a", kInfinity}}}).find("finite"), std::string::npos);
  EXPECT_NE(error_of("x = 1", {.parameters = {{"x", 1}}}).find("variable"), std::string::npos);
  EXPECT_NE(error_of("x = 1", {.parameters = {{"x7", 1}}}).find("variable"), std::string::npos);
  EXPECT_NE(error_of("x = 1", {.parameters = {{"pi", 3}}}).find("constant"), std::string::npos);
  EXPECT_NE(error_of("x = 1", {.parameters = {{"sin", 1}}}).find("function"), std::string::npos);
  EXPECT_NE(error_of("x = 1", {.parameters = {{"2a", 1}}}).find("not a name"), std::string::npos);
  EXPECT_NE(error_of("x = R1", {.parameters = {{"R2", 1}}}).find("did you mean 'R2'"), std::string::npos);
}

TEST(Formula, DimensionRulesAreChecked) {
  EXPECT_NE(error_of("z = 1", {.dim = 2}).find("dimension is 2"), std::string::npos);
  EXPECT_NE(error_of("x = 1", {.dim = 1}).find("must be 2"), std::string::npos);
  EXPECT_NE(error_of("x = 1; y = 2").find("2 equations in 2 dimensions"), std::string::npos);
  EXPECT_NE(error_of("x = y", {.domain = {"z >= 0"}}).find("in the domain"), std::string::npos);
  EXPECT_NE(error_of("x = y", {.domain = {"x = 0"}}).find("inequality"), std::string::npos);
  EXPECT_NE(error_of("x = y", {.domain = {"0 <= x >= 1"}}).find("same way"), std::string::npos);
  EXPECT_NE(error_of("x = y", {.domain = {"1 >= 0"}}).find("no variable"), std::string::npos);
}

TEST(Formula, DeepNestingAndLongSumsWork) {
  const std::size_t depth = 5000;
  const std::string nested = std::string(depth, '(') + "x" + std::string(depth, ')');
  EXPECT_EQ(at(nested + " + y", {3, 4}), 7);
  std::string functions;
  for (std::size_t i = 0; i < depth; ++i) functions += "sin(";
  EXPECT_LT(std::abs(at(functions + "x" + std::string(depth, ')') + "+0y", {1, 0})), 0.03);  // ~ sqrt(3 / depth)
  EXPECT_EQ(at(std::string(100000, '-') + "x + y", {3, 4}), 7);
  EXPECT_NE(error_of(std::string(100000, '(')).find("missing"), std::string::npos);

  const int terms = 100000;
  std::string sum = "x1";
  for (int i = 1; i < terms; ++i) sum.append(i % 2 != 0 ? "-x" : "+x").append(std::to_string(i % 7 + 1)).append("^2");
  const auto function = parse_function(sum);
  const Vector x = Vector::LinSpaced(7, 0.5, 2);
  double value = 0;
  Vector g(7);
  Eigen::MatrixXd h(7, 7);
  const double weight = 1;
  function->make_evaluator()->evaluate(
      {.n = 1, .x = x.data(), .value = &value, .jacobian = g.data(), .weight = &weight, .hessian = h.data()});
  long double expected = x(0);
  Vector expected_g = Vector::Unit(7, 0);
  for (int i = 1; i < terms; ++i) {
    const double sign = i % 2 != 0 ? -1 : 1;
    expected += sign * static_cast<long double>(x(i % 7)) * x(i % 7);
    expected_g(i % 7) += sign * 2 * x(i % 7);
  }
  EXPECT_NEAR(value, static_cast<double>(expected), 1e-10);
  EXPECT_LT((g - expected_g).norm(), 1e-7);
}

TEST(Formula, KinksAndPolesHaveDocumentedValues) {
  EXPECT_EQ(at("abs(x)+0y", {0, 0}), 0);
  EXPECT_EQ(gradient("abs(x)+0y", {0, 0})(0), 0);
  EXPECT_EQ(at("sign(x)+0y", {0, 0}), 0);
  EXPECT_EQ(at("sign(x)+0y", {-3, 0}), -1);
  EXPECT_EQ(gradient("sign(x)+y", {0, 0})(0), 0);
  EXPECT_EQ(gradient("max(2x, y)", {0, 0}), Eigen::Vector2d(2, 0));  // the first where both are equal
  EXPECT_EQ(gradient("min(y, 2x)", {0, 0}), Eigen::Vector2d(0, 1));
  EXPECT_EQ(at("sqrt(x)+0y", {0, 0}), 0);
  EXPECT_EQ(gradient("sqrt(x)+0y", {0, 0})(0), kInfinity);
  EXPECT_EQ(gradient("cbrt(x)+0y", {0, 0})(0), kInfinity);
  EXPECT_EQ(at("cbrt(x)+0y", {-8, 0}), -2);
  EXPECT_EQ(at("x^y", {0, 0}), 1);
  EXPECT_EQ(at("x^0.5+0y", {4, 0}), 2);
  EXPECT_EQ(at("x^y", {-2, 3}), -8);
  EXPECT_EQ(at("x^-1+0y", {0, 0}), kInfinity);
  EXPECT_EQ(at("atan2(y, x)", {0, 0}), 0);
  EXPECT_EQ(at("log(x)+0y", {0, 0}), -kInfinity);
  EXPECT_EQ(gradient("x^y", {0, 2}), Eigen::Vector2d(0, 0));  // log(0) is met by 0^2
  for (const char* formula : {"x^0.5+0y", "x^y", "log(x)+0y", "sqrt(x)+0y", "asin(x)+0y", "x^0.3+0y"}) {
    EXPECT_TRUE(std::isnan(at(formula, {-2, 0.5}))) << formula;
    EXPECT_TRUE(gradient(formula, {-2, 0.5}).array().isNaN().all()) << formula;
  }
  // A branch that is not taken does not hide that the value is NaN.
  EXPECT_TRUE(std::isnan(at("min(log(x), y)", {-1, 0})));
  EXPECT_TRUE(gradient("min(log(x), y)", {-1, 0}).array().isNaN().all());
  EXPECT_TRUE(std::isnan(at("x^0.2 + y^0", {kNaN, 1})));
}

TEST(Formula, NaNInOneCoordinateIsNaNEverywhereAtThatPointAlone) {
  for (const char* formula :
       {"x^2+y^2+z^2-1", "x^2+y^2-1", "x^0.5+y+z", "2^x+y+z^y", "min(x,y)+max(y,z)-1", "abs(x)+sign(y)+z"}) {
    const auto function = parse_function(formula, {.dim = 3});
    for (int coordinate = 0; coordinate < 3; ++coordinate) {
      Points x = Points::Constant(3, 9, 0.5);
      x(coordinate, 4) = kNaN;
      const Points weight = Points::Ones(1, 9);
      Points all = Points::Zero(13, 9);
      Points value(1, 9);
      Points gradient(3, 9);
      Points hessian(9, 9);
      function->make_evaluator()->evaluate({.n = 9,
                                            .x = x.data(),
                                            .value = value.data(),
                                            .jacobian = gradient.data(),
                                            .weight = weight.data(),
                                            .hessian = hessian.data()});
      all << value, gradient, hessian;
      for (Index j = 0; j < 9; ++j) {
        EXPECT_EQ(all.col(j).array().isNaN().count(), j == 4 ? 13 : 0) << formula << ", coordinate " << coordinate;
      }
    }
  }
}

TEST(Formula, AgreesWithSurfacesWrittenByHand) {
  const struct {
    Surface formula;
    Surface hand;
  } pairs[] = {
      {parse_surface("(x^2+y^2+z^2 + R^2-r^2)^2 - 4R^2*(x^2+y^2)", {.parameters = {{"R", 1}, {"r", 0.4}}}),
       test::torus()},
      {parse_surface("x^4-5x^2 + y^4-5y^2 + z^4-5z^2 + 11.8"), test::tangle_cube()},
      {parse_surface("x1^2+x2^2+x3^2+x4^2+x5^2+x6^2 = 1"), test::unit_sphere(6)},
  };
  std::srand(1);
  for (const auto& [formula, hand] : pairs) {
    ASSERT_EQ(formula.dim(), hand.dim());
    const Points x = Points::Random(hand.dim(), 50) * 2;
    EXPECT_LT((formula.value(x) - hand.value(x)).norm(), 1e-12);
    EXPECT_LT((formula.jacobian(x) - hand.jacobian(x)).norm(), 1e-12);
    const Vector weight = Vector::Constant(1, -1.5);
    EXPECT_LT((formula.hessian(x.col(0), weight) - hand.hessian(x.col(0), weight)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace taut
