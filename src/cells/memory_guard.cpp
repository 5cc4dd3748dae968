#include "cells/memory_guard.hpp"

#include <string>

#ifdef __unix__
#include <unistd.h>
#endif

#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

// Where the machine does not say how much it has.
constexpr std::size_t kAssumedMemory = std::size_t{4} << 30;

std::size_t machine_memory() {
#ifdef _SC_PHYS_PAGES
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page_size = sysconf(_SC_PAGE_SIZE);
  if (pages > 0 && page_size > 0) return static_cast<std::size_t>(pages) * static_cast<std::size_t>(page_size);
#endif
  return kAssumedMemory;
}

}  // namespace

std::size_t memory_limit(const Context& context) {
  return context.memory_limit > 0 ? context.memory_limit : machine_memory() / 2;
}

void check_memory(std::size_t bytes, std::size_t limit, Index num_cells, double size) {
  if (bytes <= limit) return;
  throw OutOfMemory("the surface has more cells of size " + describe(size) + " than fit into " +
                    std::to_string(limit >> 20) + " MB (" + std::to_string(num_cells) +
                    " so far): take larger cells (--cell) or a smaller box (--box)");
}

}  // namespace taut::detail
