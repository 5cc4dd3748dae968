#pragma once

#include <thread>

namespace taut {

/// Starts the threads that all long loops share, side by side with what the caller does next. Without it the first
/// loop does, which takes one or two milliseconds: a program that answers in 20 may mind. Keep what it returns, the
/// thread that does the starting, until the end of main.
[[nodiscard]] std::jthread start_threads();

}  // namespace taut
