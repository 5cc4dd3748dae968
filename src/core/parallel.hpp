#pragma once

#include <functional>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Calls body(first, last) for the blocks [begin, begin + grain), [begin + grain, begin + 2 grain), ... of [begin,
/// end), in any order, on up to `context.threads` threads (0 = all cores); serially where there is one block only. The
/// blocks do not depend on the number of threads, so a body that writes only the slots of its own block gives the same
/// result on any. Checks for cancellation before each block; what a body throws comes out here, after the running
/// blocks have ended.
void parallel_for(const Context& context, Index begin, Index end, Index grain,
                  const std::function<void(Index first, Index last)>& body);

/// How many threads a loop may have: at least 1.
[[nodiscard]] Index num_threads(const Context& context);

}  // namespace taut::detail
