#pragma once

#include <vector>

#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// For each component of `function`, whether it is known to be affine, a . x + b, by the form of its formula. False for
/// functions that are no formulas.
[[nodiscard]] std::vector<bool> affine_components(const ImplicitFunction& function);

}  // namespace taut::detail
