// One message for all that runs out of memory while cells are made: how many there are, and what helps.
#include "cells/memory_guard.hpp"

#include <string>

#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {

void check_memory(std::size_t bytes, std::size_t limit, Index num_cells, double size) {
  if (bytes <= limit) return;
  throw OutOfMemory("the surface has more cells of size " + describe(size) + " than fit into " +
                    std::to_string(limit >> 20) + " MB (" + std::to_string(num_cells) +
                    " so far): take larger cells (option cell) or a smaller box (option box)");
}

}  // namespace taut::detail
