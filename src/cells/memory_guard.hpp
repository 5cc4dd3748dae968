#pragma once

#include <cstddef>

#include "core/memory_limit.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Throws OutOfMemory when `bytes` is above `limit`, saying how many cells of which size there are so far and what to
/// do.
void check_memory(std::size_t bytes, std::size_t limit, Index num_cells, double size);

}  // namespace taut::detail
