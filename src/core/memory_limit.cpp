#include "core/memory_limit.hpp"

#include "core/machine_memory.hpp"

namespace taut::detail {

std::size_t memory_limit(const Context& context) {
  return context.memory_limit > 0 ? context.memory_limit : machine_memory() / 2;
}

}  // namespace taut::detail
