#pragma once

#include <cstddef>

#include "taut/core/types.hpp"

namespace taut::detail {

// What the formula engine accepts; more is refused with a message that names the limit.
inline constexpr std::size_t kMaxFormulaBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxNodes = std::size_t{20} << 20;
inline constexpr Index kMaxDim = 65'535;  // of variables and of equations: entries of d x d fit 32 bits

}  // namespace taut::detail
