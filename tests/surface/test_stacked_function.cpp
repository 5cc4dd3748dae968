#include "surface/stacked_function.hpp"

#include <gtest/gtest.h>

#include "taut/surface/conformance.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(StackedFunction, KeepsWhatEvaluatorsPromise) {
  FormulaOptions options;
  options.dim = 4;
  options.domain = {"x1^3-x2*x4>=0", "sin(x1)+x3*x4^2>=0.1", "x4<=2"};
  const Surface surface = parse_surface("x1^2+exp(x2)*x3=1; x4^3+x1*x2*x3", options);
  const Box box{Vector::Constant(4, -1), Vector::Constant(4, 1)};
  for (const std::vector<Index>& components : {std::vector<Index>{}, {1}, {2, 0}}) {
    const detail::StackedFunction stacked(surface, components);
    EXPECT_EQ(stacked.codim(), 2 + static_cast<Index>(components.size()));
    const ConformanceReport report = check_conformance(stacked, box);
    EXPECT_TRUE(report.ok()) << report.text();
  }
}

}  // namespace
}  // namespace taut
