#include "surface/sign_evaluator.hpp"

#include <algorithm>
#include <vector>

namespace taut::detail {

void are_nonnegative(Evaluator& evaluator, Index codim, Index n, const double* x, bool* answer) {
  if (auto* const knows = dynamic_cast<SignEvaluator*>(&evaluator)) return knows->are_nonnegative(n, x, answer);
  std::vector<double> value(static_cast<std::size_t>(codim * n));
  evaluator.evaluate({.n = n, .x = x, .value = value.data()});
  for (Index j = 0; j < n; ++j) {
    const double* const at = value.data() + j * codim;
    answer[j] = std::all_of(at, at + codim, [](double v) { return v >= 0; });
  }
}

}  // namespace taut::detail
