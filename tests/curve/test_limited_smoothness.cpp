// Surfaces whose equation is not smooth: the error estimate has to hold there, too. Truth: arc lengths of plane
// sections of symmetry by Gauss quadrature.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "taut/curve/newton.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

/// A section y = height(x) of a surface by z = 0, its plane of symmetry.
struct Section {
  std::string formula;
  std::function<double(double)> height;
  std::function<double(double)> slope;
};

std::vector<Section> sections() {
  const auto power = [](double e) {
    const std::string text = std::to_string(e);
    return Section{"pow(abs(x)," + text + ")+pow(abs(y)," + text + ")+z^2=1",
                   [e](double x) { return std::pow(1 - std::pow(std::abs(x), e), 1 / e); },
                   [e](double x) {
                     const double y = std::pow(1 - std::pow(std::abs(x), e), 1 / e);
                     return -std::copysign(std::pow(std::abs(x) / y, e - 1), x);
                   }};
  };
  const auto dent = [](int e) {
    const auto bump = [e](double x) { return 2 * std::pow(std::max(x, 0.0), e); };
    const auto height = [bump](double x) { return std::sqrt(1 - x * x - bump(x)); };
    return Section{"x^2+y^2+z^2+2*max(x,0)^" + std::to_string(e) + "=1", height,
                   [e, height](double x) { return -(x + e * std::pow(std::max(x, 0.0), e - 1)) / height(x); }};
  };
  return {power(3), power(2.5), power(1.5), dent(2), dent(3)};
}

/// Composite Gauss quadrature over 0 .. end, four nodes a panel: exact to rounding for what is smooth.
double integral(const std::function<double(double)>& f, double end) {
  constexpr int kPanels = 1000;
  const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
  const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
  const double heavy = (18 + std::sqrt(30.0)) / 36;
  const double half = end / (2 * kPanels);
  double sum = 0;
  for (int panel = 0; panel < kPanels; ++panel) {
    const double middle = (2 * panel + 1) * half;
    sum += heavy * (f(middle - inner * half) + f(middle + inner * half));
    sum += (1 - heavy) * (f(middle - outer * half) + f(middle + outer * half));
  }
  return half * sum;
}

double arc_length(const Section& section, double from, double to) {
  const auto speed = [&](double x) { return std::hypot(1, section.slope(x)); };
  double sum = 0;
  for (const double half : {from, to}) {  // the kink is at 0; |x|^0.5 beside it: x = t^4
    const auto along = [&](double t) {
      const double x = std::copysign(t * t * t * t, half);
      return speed(x) * 4 * t * t * t;
    };
    sum += integral(along, std::pow(std::abs(half), 0.25));
  }
  return sum;
}

TEST(LimitedSmoothness, TheErrorEstimateCoversTheError) {
  int cases = 0;
  int uncovered = 0;
  for (const Section& section : sections()) {
    const Surface surface = parse_surface(section.formula);
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
      NewtonSolver solver(surface, {.tolerance = tolerance});
      for (const double from : {-0.6, -0.35, -0.11}) {
        for (const double to : {0.05, 0.3, 0.52}) {
          Points start(3, 21);
          for (Index i = 0; i <= 20; ++i) {
            const double x = from + (to - from) * static_cast<double>(i) / 20;
            start.col(i) << x, section.height(x), 0.02 * std::sin(3.14159265358979 * static_cast<double>(i) / 20);
          }
          start(2, 0) = start(2, 20) = 0;
          const NewtonResult result = solver.solve(start);
          const double truth = arc_length(section, from, to);
          const double error = std::abs(result.length - truth);
          ASSERT_EQ(result.status, Status::ok) << section.formula << " " << result.reason;
          EXPECT_LE(error, tolerance * truth) << section.formula << " from " << from << " to " << to;
          EXPECT_LE(error, 5 * result.length_error + 1e-13) << section.formula << " from " << from << " to " << to;
          ++cases;
          uncovered += error > result.length_error + 1e-14 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_LE(uncovered, cases / 50) << "of " << cases;
}

}  // namespace
}  // namespace taut
