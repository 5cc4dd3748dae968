// Elementary functions on SIMD lanes against long double (64-bit significand): errors in units in the last place.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "surface/simd_dispatch.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

const double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> values_of(const std::string& function, const std::vector<double>& x) {
  const auto f = parse_function(function + "(x)", {.dim = 2});
  Points points = Points::Zero(2, static_cast<Index>(x.size()));
  for (std::size_t j = 0; j < x.size(); ++j) points(0, static_cast<Index>(j)) = x[j];
  std::vector<double> result(x.size());
  f->make_evaluator()->evaluate({.n = points.cols(), .x = points.data(), .value = result.data()});
  return result;
}

/// |found - expected| in units of the last place of the expected double; subnormal results count in the smallest one.
double ulp_error(double found, long double expected) {
  if (std::isnan(found) && std::isnan(expected)) return 0;
  const auto rounded = static_cast<double>(expected);
  if (found == rounded) {
    if (!std::isfinite(rounded)) return 0;
  } else if (!std::isfinite(found) || !std::isfinite(rounded)) {
    return kInfinity;
  }
  const int exponent = rounded == 0 ? -1074 : std::max(std::ilogb(rounded) - 52, -1074);
  return static_cast<double>(std::abs(static_cast<long double>(found) - expected) / std::ldexp(1.0L, exponent));
}

struct Accuracy {
  const char* name;
  long double (*reference)(long double);
  double low;
  double high;
  double max_ulp;  ///< tested bound; interval bounds allow for 8
};

TEST(FormulaMath, ElementaryFunctionsAreAccurate) {
  const Accuracy table[] = {
      {"exp", std::exp, -745, 709.7, 1},  {"exp", std::exp, -1, 1, 1},       {"log", std::log, 0, 1e3, 1},
      {"log", std::log, 0.5, 2, 1},       {"sin", std::sin, -10, 10, 1},     {"sin", std::sin, -5e5, 5e5, 1},
      {"sin", std::sin, -1e-3, 1e-3, 1},  {"sin", std::sin, 1e8, 1e9, 1},    {"cos", std::cos, -10, 10, 1},
      {"cos", std::cos, -5e5, 5e5, 1},    {"tan", std::tan, -10, 10, 2.5},   {"tan", std::tan, -5e5, 5e5, 2.5},
      {"sqrt", std::sqrt, 0, 1e10, 0.51}, {"cbrt", std::cbrt, -1e3, 1e3, 4}, {"asin", std::asin, -1, 1, 2},
      {"acos", std::acos, -1, 1, 2},      {"atan", std::atan, -100, 100, 2}, {"sinh", std::sinh, -20, 20, 3},
      {"cosh", std::cosh, -20, 20, 3},    {"tanh", std::tanh, -20, 20, 3},
  };
  std::mt19937_64 random(7);
  for (const Accuracy& row : table) {
    std::uniform_real_distribution<double> uniform(row.low, row.high);
    std::vector<double> x(40000);
    for (double& value : x) value = uniform(random);
    const std::vector<double> found = values_of(row.name, x);
    double worst = 0;
    double where = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double error = ulp_error(found[j], row.reference(x[j]));
      if (error > worst) {
        worst = error;
        where = x[j];
      }
    }
    EXPECT_LE(worst, row.max_ulp) << row.name << " at " << where;
    RecordProperty(std::string(row.name) + std::to_string(row.high), std::to_string(worst));
    if (testing::Test::HasFailure() || std::getenv("TAUT_PRINT_ULP") != nullptr) {
      std::printf("%s on [%g, %g]: %.3f ulp\n", row.name, row.low, row.high, worst);
    }
  }
}

TEST(FormulaMath, AnglesNearMultiplesOfHalfPiKeepTheirDigits) {
  std::vector<double> x;
  for (int k = 1; k < 300000; k += 37) {
    const double angle = k * (std::numbers::pi / 2);
    x.insert(x.end(), {angle, std::nextafter(angle, 0), std::nextafter(angle, kInfinity), -angle});
  }
  // The double below 2^19 that lies closest to a multiple of pi/2 in the sense of relative cancellation, and a few
  // more.
  x.insert(x.end(), {std::numbers::pi, std::numbers::pi / 2, 3.0 * std::numbers::pi / 4, 524287.99, -524288, 524289});
  // The x87 reduces with a 66-bit pi, so the reference is reduced by hand in long double parts of pi/2.
  const auto exact = [](double angle, bool cosine) {
    const long double k = std::nearbyint(angle / std::numbers::pi_v<long double> * 2);
    long double r = angle - k * 0x1.921fb54400000p0L;
    r -= k * 0x1.0b4611a600000p-34L;
    r -= k * 0x1.3198a2e000000p-69L;
    r -= k * 0x1.b839a252049c1p-104L;
    switch ((static_cast<long>(k) + (cosine ? 1 : 0)) & 3) {
      case 0: return std::sin(r);
      case 1: return std::cos(r);
      case 2: return -std::sin(r);
      default: return -std::cos(r);
    }
  };
  const std::vector<double> sine = values_of("sin", x);
  const std::vector<double> cosine = values_of("cos", x);
  for (std::size_t j = 0; j < x.size(); ++j) {
    EXPECT_LE(ulp_error(sine[j], exact(x[j], false)), 1) << "sin " << x[j];
    EXPECT_LE(ulp_error(cosine[j], exact(x[j], true)), 1) << "cos " << x[j];
    EXPECT_LE(std::abs(sine[j]), 1);
    EXPECT_LE(std::abs(cosine[j]), 1);
  }
}

TEST(FormulaMath, SpecialValues) {
  const double smallest = std::numeric_limits<double>::denorm_min();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x{0.0, -0.0, 1,      -1,     kInfinity, -kInfinity, nan,   smallest, -smallest, 1e-310,
                              710, -746, 709.78, -745.1, 1e22,      -1e300,     1e300, 2e-308,   -1e-20,    88};
  const std::pair<const char*, double (*)(double)> functions[] = {
      {"exp", std::exp},   {"log", std::log},   {"sin", std::sin},   {"cos", std::cos},   {"tan", std::tan},
      {"sqrt", std::sqrt}, {"cbrt", std::cbrt}, {"asin", std::asin}, {"acos", std::acos}, {"atan", std::atan},
      {"sinh", std::sinh}, {"cosh", std::cosh}, {"tanh", std::tanh}};
  for (const auto& [name, reference] : functions) {
    const std::vector<double> found = values_of(name, x);
    for (std::size_t j = 0; j < x.size(); ++j) {
      EXPECT_LE(ulp_error(found[j], reference(x[j])), 2) << name << "(" << x[j] << ") = " << found[j];
    }
  }
}

TEST(FormulaMath, LanesDoNotDependOnTheirNeighbours) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-8, 8);
  std::vector<double> x(37);
  for (double& value : x) value = uniform(random);
  x[5] = 1e30;  // takes the slow path of sin
  x[6] = kInfinity;
  for (const char* name : {"exp", "log", "sin", "cos", "tan", "cbrt", "tanh"}) {
    const std::vector<double> together = values_of(name, x);
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double alone = values_of(name, {x[j]})[0];
      EXPECT_TRUE(alone == together[j] || (std::isnan(alone) && std::isnan(together[j]))) << name << " " << x[j];
    }
  }
}

/// The C library's own functions (tanh and the like) may differ between machines; what runs in lanes may not.
TEST(FormulaMath, EveryInstructionSetGivesTheSameBits) {
  const auto function = parse_function(
      "(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2) + sin(x*y)*exp(z) - sqrt(abs(x))/cos(z) + tan(y);"
      "max(x*y*z, log(x^2+y^2)) - min(y, z, x^3)*sign(x)");
  std::srand(11);
  const Index n = 77;
  const Points x = Points::Random(3, n) * 3;
  const Points upper = x.array() + 0.1;
  const Points weight = Points::Random(2, n);
  Points first;
  const detail::InstructionSet best = detail::instruction_set();
  for (const auto set : {detail::InstructionSet::baseline, detail::InstructionSet::sse4, detail::InstructionSet::avx2,
                         detail::InstructionSet::avx512}) {
    if (!detail::has_instruction_set(set)) continue;
    detail::use_instruction_set(set);
    const auto evaluator = function->make_evaluator();
    Points all(2 + 6 + 9 + 4, n);
    Points value(2, n);
    Points jacobian(6, n);
    Points hessian(9, n);
    Points lower_bound(2, n);
    Points upper_bound(2, n);
    evaluator->evaluate({.n = n,
                         .x = x.data(),
                         .value = value.data(),
                         .jacobian = jacobian.data(),
                         .weight = weight.data(),
                         .hessian = hessian.data()});
    evaluator->bounds({.n = n,
                       .lower = x.data(),
                       .upper = upper.data(),
                       .value_lower = lower_bound.data(),
                       .value_upper = upper_bound.data()});
    all << value, jacobian, hessian, lower_bound, upper_bound;
    if (first.size() == 0) first = all;
    EXPECT_EQ(std::memcmp(first.data(), all.data(), sizeof(double) * static_cast<std::size_t>(all.size())), 0)
        << static_cast<int>(set);
  }
  detail::use_instruction_set(best);
}

}  // namespace
}  // namespace taut
