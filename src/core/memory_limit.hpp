#pragma once

#include <cstddef>

#include "taut/core/context.hpp"

namespace taut::detail {

/// Bytes a job under this context may hold: its limit, or half of what the machine gives to this process.
[[nodiscard]] std::size_t memory_limit(const Context& context);

}  // namespace taut::detail
