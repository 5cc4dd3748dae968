#include "core/parallel.hpp"

#include <algorithm>
#include <cassert>

#ifdef TAUT_THREADS
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace taut::detail {

void parallel_for(const Context& context, Index begin, Index end, Index grain,
                  const std::function<void(Index first, Index last)>& body) {
  assert(grain > 0);
  if (end <= begin) return;
  const Index num_blocks = (end - begin + grain - 1) / grain;
  const auto run_block = [&](Index block) {
    context.check_cancelled();
    const Index first = begin + block * grain;
    body(first, std::min(first + grain, end));
  };
#ifdef TAUT_THREADS
  if (num_blocks > 1 && context.threads != 1) {
    const auto run_blocks = [&](const tbb::blocked_range<Index>& range) {
      for (Index block = range.begin(); block != range.end(); ++block) run_block(block);
    };
    // More than there are cores would make TBB print a warning.
    const int num_cores = tbb::info::default_concurrency();
    tbb::task_arena arena(context.threads > 0 ? std::min(context.threads, num_cores) : num_cores);
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<Index>(0, num_blocks), run_blocks); });
    return;
  }
#endif
  for (Index block = 0; block < num_blocks; ++block) run_block(block);
}

}  // namespace taut::detail
