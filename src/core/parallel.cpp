#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <system_error>

#include "taut/core/context.hpp"

// TBB's own synchronisation is invisible to the thread sanitizer: under it, plain threads take its place.
#if defined(TAUT_THREADS) && defined(__SANITIZE_THREAD__)
#define TAUT_PLAIN_THREADS
#include <exception>
#include <mutex>
#include <vector>
#elif defined(TAUT_THREADS)
#define TAUT_TBB
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace taut::detail {
namespace {

#ifdef TAUT_PLAIN_THREADS
constexpr int kPlainThreads = 4;  // however few cores there are

template <class RunBlock>
void run_on_plain_threads(Index num_threads, Index num_blocks, const RunBlock& run_block) {
  std::atomic<Index> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (Index block = next++; block < num_blocks; block = next++) run_block(block);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = num_blocks;
    }
  };
  std::vector<std::jthread> others;
  for (Index i = 1; i < num_threads; ++i) others.emplace_back(work);
  work();
  others.clear();
  if (failure) std::rethrow_exception(failure);
}
#endif

}  // namespace

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
#ifdef TAUT_PLAIN_THREADS
  if (num_blocks > 1 && context.threads != 1) return run_on_plain_threads(num_threads(context), num_blocks, run_block);
#endif
#ifdef TAUT_TBB
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
#if defined(TAUT_PLAIN_THREADS)
  return context.threads > 0 ? context.threads : kPlainThreads;
#elif defined(TAUT_TBB)
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
#ifdef TAUT_TBB
  static constexpr std::chrono::microseconds kLongest(300);  // for the next thread to appear
  const auto start = [] {
    const Index num_threads = detail::num_threads(Context{});
    std::atomic<Index> num_here = 0;
    detail::parallel_for(Context{}, 0, num_threads, 1, [&](Index, Index) {
      ++num_here;
      const auto until = std::chrono::steady_clock::now() + kLongest;
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
