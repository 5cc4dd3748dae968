#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>
#include <thread>

#include "taut/core/error.hpp"

namespace taut {

/// What every long loop takes: how many threads, whom to tell, when to stop. A default one is silent, uses every core
/// and is never cancelled. Copy it freely; it owns nothing but the callback.
struct Context {
  /// 0 = all cores. The number of threads never changes a result.
  int threads = 0;
  /// Called now and then, from one thread at a time: a stage's name ("cells", "march", "fit") and how much of it is
  /// done, 0..1, or a negative number where the total is not known.
  std::function<void(std::string_view stage, double done)> progress = nullptr;
  /// Something the user should know that is no error ("10,345 points: a well-spread subset of 1,500 is fitted").
  std::function<void(std::string_view message)> note = nullptr;
  /// Raise it from anywhere (a signal handler, another thread) to stop: the job throws `Cancelled` within milliseconds.
  const std::atomic<bool>* cancel = nullptr;
  /// Bytes a job may hold; a job that would need more throws `OutOfMemory`. 0 = half of the machine's memory, or of the
  /// limit of this process or container where that is less.
  std::size_t memory_limit = 0;

  void report(std::string_view stage, double done) const {
    if (progress) progress(stage, done);
  }
  void tell(std::string_view message) const {
    if (note) note(message);
  }
  void check_cancelled() const {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
  }
};

/// Starts the threads that all long loops share, side by side with what the caller does next. Without it the first
/// loop does, which takes one or two milliseconds: a program that answers in 20 may mind. Keep what it returns, the
/// thread that does the starting, until the end of main.
[[nodiscard]] std::jthread start_threads();

}  // namespace taut
