// The formula parser on arbitrary text: it must throw a ParseError whose column lies in the text, or give a function
// that evaluates, with derivatives and bounds, at any point.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace {

constexpr taut::Index kLargestDim = 64;  // above, a dense Hessian only costs time

void require(bool condition) {
  if (!condition) std::abort();
}

void evaluate(const taut::ImplicitFunction& function) {
  const taut::Index d = function.dim();
  const taut::Index k = function.codim();
  if (d > kLargestDim || k > kLargestDim) return;
  const taut::Vector x = taut::Vector::LinSpaced(d, -1.5, 2);
  const taut::Vector upper = x.array() + 0.25;
  const taut::Vector weight = taut::Vector::Ones(k);
  taut::Vector value(k), jacobian(d * k), hessian(d * d), product(d), low(k), high(k);
  const auto evaluator = function.make_evaluator();
  evaluator->evaluate({.n = 1,
                       .x = x.data(),
                       .value = value.data(),
                       .jacobian = jacobian.data(),
                       .weight = weight.data(),
                       .hessian = hessian.data()});
  evaluator->hessian_times({.n = 1, .x = x.data(), .weight = weight.data()}, x.data(), product.data());
  evaluator->bounds(
      {.n = 1, .lower = x.data(), .upper = upper.data(), .value_lower = low.data(), .value_upper = high.data()});
  for (taut::Index i = 0; i < k; ++i) {
    require(std::isnan(value(i)) || (low(i) <= value(i) && value(i) <= high(i)));
  }
}

/// Throws nothing but what a formula may end in.
void read(std::string_view text, const taut::FormulaOptions& options) {
  try {
    evaluate(*taut::parse_function(text, options));
  } catch (const taut::ParseError& error) {
    require(error.column() <= text.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read(text, {.parameters = {{"r", 0.5}}});
  read(text, {.variables = {"x", "theta", "\u03C6"}});
  return 0;
}
