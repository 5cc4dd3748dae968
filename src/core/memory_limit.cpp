#include "core/memory_limit.hpp"

#ifdef __unix__
#include <unistd.h>
#endif

namespace taut::detail {
namespace {

// Where the machine does not say how much it has.
[[maybe_unused]] constexpr std::size_t kAssumedMemory = std::size_t{4} << 30;

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

}  // namespace taut::detail
