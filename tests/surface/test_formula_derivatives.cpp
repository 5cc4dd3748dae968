#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "taut/surface/conformance.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

struct Operator {
  const char* formula;
  double low = -2;
  double high = 2;
};

/// Every operator and function, where it is defined, composed so that second derivatives of it matter.
const Operator kOperators[] = {
    {"x + y*z"},
    {"x - y*z - 3"},
    {"-(x*y)^2"},
    {"x*y*z + x^2*y"},
    {"x/y + 2/z - y/(1+z^2)", 0.3, 2},
    {"(x*y)^2 + x^3 - y^5*z^7"},
    {"x^-1 + y^-3*z^-2", 0.4, 2},
    {"x^0.5 + y^1.5 + z^-2.5", 0.3, 2},
    {"x^0.3 + y^2.7 - pow(z, -1.1)", 0.3, 2},
    {"x^y + y^z", 0.3, 2},
    {"2^x + 0.5^(y*z)"},
    {"sqrt(x*y + z)", 0.3, 2},
    {"sqrt(x^2 + y^2) - z"},
    {"cbrt(x*y*z)"},
    {"abs(x)*y + abs(z)^3"},
    {"sign(x)*y^2 + z"},
    {"exp(x*y - z)"},
    {"log(x*y + z^2)", 0.3, 2},
    {"sin(x*y) + sin(z)^2"},
    {"cos(x*y) - cos(2z)*x"},
    {"tan(x*y/4) + tan(z/2)", -1, 1},
    {"asin(x*y) + asin(z)", -0.9, 0.9},
    {"acos(x*y) - acos(z)", -0.9, 0.9},
    {"atan(x*y) + atan(z/2)"},
    {"atan2(x*y, z) + atan2(z, x)", 0.2, 2},
    {"atan2(y, x) + z"},
    {"sinh(x*y) - sinh(z)"},
    {"cosh(x*y) + cosh(z)*x"},
    {"tanh(x*y) + tanh(2z)"},
    {"min(x*y, z^2) + min(x, y, z)"},
    {"max(x*y, z^2) - max(x, 2y, 3z)"},
    {"max(min(x^2+y^2-1, z^2-1), x*y*z)"},
    {"min(sin(x), cos(y))*max(exp(z), x^2)"},
    {"(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"},
    {"sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)"},
    {"(2*(x^2+y^2+z^2)-1)^3 - x^2*z^3/10 - y^2*z^3"},
};

TEST(FormulaDerivatives, EveryOperatorConforms) {
  for (const Operator& row : kOperators) {
    SCOPED_TRACE(row.formula);
    const auto function = parse_function(row.formula);
    const Index d = function->dim();
    const ConformanceReport report =
        check_conformance(*function, {Vector::Constant(d, row.low), Vector::Constant(d, row.high)});
    EXPECT_TRUE(report.ok()) << report.text();
    EXPECT_GT(report.num_checks, 1000);
    EXPECT_LT(report.num_skipped, report.num_checks / 2);
  }
}

TEST(FormulaDerivatives, SeveralEquationsConform) {
  for (const char* formula : {
           "x^2+y^2+z^2+w^2 = 1; x*y = z*w; sin(x) = exp(w)*z",
           "x1^2+x2^2 = 0.5; x3^2+x4^2 = 0.5",
           "max(x1, x2*x3) = 0; abs(x5) = x4; x1 + x2 = 0",
           "x1*x4+x2*x5+x3*x6 = 0; x1^2+x2^2+x3^2 = 1; x4^2+x5^2+x6^2 = 1; x7*x1 = x8; x9 = log(1+x1^2)",
       }) {
    SCOPED_TRACE(formula);
    const auto function = parse_function(formula);
    const Index d = function->dim();
    const ConformanceReport report =
        check_conformance(*function, {Vector::Constant(d, -1.5), Vector::Constant(d, 1.5)});
    EXPECT_TRUE(report.ok()) << report.text();
  }
}

TEST(FormulaDerivatives, ManyDimensionsConform) {
  for (const int d : {10, 50}) {
    std::string sphere;
    std::string chain;
    for (int i = 1; i <= d; ++i) {
      const std::string x = "x" + std::to_string(i);
      sphere.append(i > 1 ? "+" : "").append(x).append("^2");
      if (i > 1)
        chain.append(i > 2 ? "+" : "").append("x").append(std::to_string(i - 1)).append("*sin(").append(x).append(")");
    }
    for (const std::string& formula : {sphere + "=1", chain, "(" + sphere + ")^2 - exp(x1*x2)"}) {
      const auto function = parse_function(formula);
      const ConformanceReport report =
          check_conformance(*function, {Vector::Constant(d, -1), Vector::Constant(d, 1)}, {.num_points = 3});
      EXPECT_TRUE(report.ok()) << report.text();
    }
  }
}

/// sum over all i < j of x_i x_j sin(...), so dense that the Hessian is taken column by column.
TEST(FormulaDerivatives, DenseHessianInManyDimensionsByColumns) {
  const Index d = 700;
  std::string sum;
  for (Index i = 1; i <= d; ++i) sum.append(i > 1 ? "+" : "").append("x").append(std::to_string(i)).append("^2");
  const auto function = parse_function("(" + sum + ")^2 + sin(x1*x2)");
  const auto evaluator = function->make_evaluator();
  std::srand(3);
  const Points x = Points::Random(d, 2);
  const Vector weight = Vector::Constant(2, 0.5);
  Points hessian(d * d, 2);
  Points jacobian(d, 2);
  evaluator->evaluate(
      {.n = 2, .x = x.data(), .jacobian = jacobian.data(), .weight = weight.data(), .hessian = hessian.data()});
  for (Index j = 0; j < 2; ++j) {
    const Vector p = x.col(j);
    Eigen::MatrixXd expected = 8 * p * p.transpose();
    expected.diagonal().array() += 4 * p.squaredNorm();
    const double s = std::sin(p(0) * p(1));
    const double c = std::cos(p(0) * p(1));
    expected(0, 0) -= p(1) * p(1) * s;
    expected(1, 1) -= p(0) * p(0) * s;
    expected(0, 1) += c - p(0) * p(1) * s;
    expected(1, 0) = expected(0, 1);
    const Eigen::Map<const Eigen::MatrixXd> h(hessian.col(j).data(), d, d);
    EXPECT_LT((h - 0.5 * expected).norm(), 1e-12 * expected.norm());
    EXPECT_EQ(h, h.transpose());
    const Vector v = Vector::Random(d);
    Vector product(d);
    evaluator->hessian_times({.n = 1, .x = p.data(), .weight = weight.data()}, v.data(), product.data());
    EXPECT_LT((product - h * v).norm(), 1e-11 * product.norm());
  }
}

/// A batch of any length, at any offset, gives the bits of single points: blocks, padding and tails do not show.
TEST(FormulaDerivatives, BatchesOfAllSizesGiveTheSameBits) {
  const auto function =
      parse_function("(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2) + sin(x*y)*exp(z) - tanh(x); x*y*z - cbrt(z)");
  const auto evaluator = function->make_evaluator();
  std::srand(5);
  const Index n = 300;
  const Points x = Points::Random(3, n) * 3;
  const Points weight = Points::Random(2, n);
  Points value(2, n);
  Points jacobian(6, n);
  Points hessian(9, n);
  evaluator->evaluate({.n = n,
                       .x = x.data(),
                       .value = value.data(),
                       .jacobian = jacobian.data(),
                       .weight = weight.data(),
                       .hessian = hessian.data()});
  for (const Index size : {1, 2, 3, 7, 8, 9, 63, 64, 65, 127, 128, 129}) {
    Points v(2, n);
    Points j(6, n);
    Points h(9, n);
    for (Index first = 0; first < n; first += size) {
      const Index count = std::min(size, n - first);
      evaluator->evaluate({.n = count,
                           .x = x.col(first).data(),
                           .value = v.col(first).data(),
                           .jacobian = j.col(first).data(),
                           .weight = weight.col(first).data(),
                           .hessian = h.col(first).data()});
    }
    EXPECT_EQ(v, value) << size;
    EXPECT_EQ(j, jacobian) << size;
    EXPECT_EQ(h, hessian) << size;
  }
}

}  // namespace
}  // namespace taut
