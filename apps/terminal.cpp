#include "terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <string>

#include "exit_code.hpp"

namespace taut::app {
namespace {

std::atomic<bool> g_cancelled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "raised inside a signal handler");

extern "C" void on_interrupt(int /*signal*/) {
  if (g_cancelled.exchange(true)) _exit(kInterrupted);
}

/// Redraws one line on stderr, at most ten times a second.
class ProgressLine {
 public:
  void update(std::string_view stage, double done, bool terminal) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (stage == stage_ && now - drawn_ < std::chrono::milliseconds(terminal ? 100 : 1000)) return;
    if (stage != stage_) {
      // A stage shorter than this never shows.
      stage_ = stage;
      drawn_ = now;
      return;
    }
    drawn_ = now;
    const std::string text =
        done < 0 ? fmt::format("{}: {:.0f}", stage, -done) : fmt::format("{}: {:3.0f} %", stage, 100 * done);
    if (terminal) {
      constexpr int kWidth = 30;
      const int filled = done < 0 ? 0 : static_cast<int>(done * kWidth);
      fmt::print(stderr, "\r\033[K{:<{}}{:<{}} {}", std::string(static_cast<std::size_t>(filled), '#'), filled, "",
                 kWidth - filled, text);
      std::fflush(stderr);
      visible_ = true;
    } else {
      fmt::print(stderr, "{}\n", text);
    }
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    if (visible_) fmt::print(stderr, "\r\033[K");
    visible_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  std::string stage_;
  Clock::time_point drawn_;
  bool visible_ = false;
};

ProgressLine g_progress;

}  // namespace

Context terminal_context(const TerminalOptions& options) {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);

  Context context;
  context.threads = options.threads;
  context.cancel = &g_cancelled;
  if (options.quiet) return context;
  context.note = [](std::string_view message) {
    g_progress.clear();
    fmt::print(stderr, "taut: note: {}\n", message);
  };
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal || options.progress) {
    context.progress = [terminal](std::string_view stage, double done) { g_progress.update(stage, done, terminal); };
  }
  return context;
}

void clear_progress() { g_progress.clear(); }

std::string in_flags(std::string_view message) {
  constexpr std::string_view kOption = "(option ";
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const std::size_t begin = message.find(kOption, at);
    text += message.substr(at, begin - at);
    if (begin == std::string_view::npos) break;
    const std::size_t name = begin + kOption.size();
    const std::size_t end = std::min(message.find_first_of(" )", name), message.size());
    text += "(--";
    for (const char c : message.substr(name, end - name)) text += c == '_' ? '-' : c;
    at = end;
  }
  return text;
}

void print_error(std::string_view message) {
  clear_progress();
  fmt::print(stderr, "taut: {}\n", in_flags(message));
}

}  // namespace taut::app
