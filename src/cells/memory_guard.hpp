#pragma once

#include <cstddef>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Bytes a job under this context may hold: its limit, or half of the machine's memory.
[[nodiscard]] std::size_t memory_limit(const Context& context);

/// Throws OutOfMemory when `bytes` is above `limit`, saying how many cells of which size there are so far and what to
/// do.
void check_memory(std::size_t bytes, std::size_t limit, Index num_cells, double size);

}  // namespace taut::detail
