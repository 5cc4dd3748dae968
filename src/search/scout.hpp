#pragma once

#include "taut/curve/exponential_map.hpp"

namespace taut::detail {

/// For short rays that only look where starts may go: to three digits, and one that winds round a spike for more steps
/// is given up.
inline constexpr ExponentialOptions kScout{.tolerance = 1e-3, .max_steps = 30, .conjugate = false};

}  // namespace taut::detail
