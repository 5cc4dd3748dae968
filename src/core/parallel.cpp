#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <system_error>

#include "taut/core/threads.hpp"

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
    const auto run_all = [&] { tbb::parallel_for(tbb::blocked_range<Index>(0, num_blocks), run_blocks); };
    if (context.threads == 0) {
      // In an arena that lasts, whose threads are still about; isolated, so that a body waiting for a loop of its own
      // does not start another block of this one meanwhile.
      tbb::this_task_arena::isolate(run_all);
    } else {
      tbb::task_arena arena(static_cast<int>(num_threads(context)));
      arena.execute(run_all);
    }
    return;
  }
#endif
  for (Index block = 0; block < num_blocks; ++block) run_block(block);
}

Index num_threads(const Context& context) {
#ifdef TAUT_THREADS
  const int num_cores = tbb::info::default_concurrency();
  // More than there are cores would make TBB print a warning.
  return context.threads > 0 ? std::min(context.threads, num_cores) : num_cores;
#else
  static_cast<void>(context);
  return 1;
#endif
}

}  // namespace taut::detail

namespace taut {

std::jthread start_threads() {
#ifdef TAUT_THREADS
  static constexpr std::chrono::microseconds kLongest(300);  // for a thread to appear
  const auto start = [] {
    const auto until = std::chrono::steady_clock::now() + kLongest;
    const Index num_threads = detail::num_threads(Context{});
    std::atomic<Index> num_here = 0;
    detail::parallel_for(Context{}, 0, num_threads, 1, [&](Index, Index) {
      ++num_here;
      while (num_here < num_threads && std::chrono::steady_clock::now() < until) std::this_thread::yield();
    });
  };
  try {
    return std::jthread(start);
  } catch (const std::system_error&) {
    return {};  // no thread to be had: they start when they are needed
  }
#else
  return {};
#endif
}

}  // namespace taut
