#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/temp_folder.hpp"

extern char** environ;

namespace taut::test {

/// What a program left behind.
struct ProgramResult {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;
  bool timed_out = false;
  std::string out;
  std::string err;
};

/// The taut program at work. Its stdout goes to a file, or to `device` if given, which is not read back; its stdin is
/// the file `input`.
class RunningProgram {
 public:
  explicit RunningProgram(const std::vector<std::string>& arguments, const std::string& device = "",
                          const std::string& input = "/dev/null")
      : device_(device), out_((folder_.path() / "out").string()), err_((folder_.path() / "err").string()) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, input.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, (device.empty() ? out_ : device).c_str(),
                                     O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), O_WRONLY | O_CREAT, 0600);
    std::vector<std::string> words = {TAUT_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int error = posix_spawn(&child_, TAUT_PROGRAM, &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " TAUT_PROGRAM);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram() {
    if (!ended_) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }

  /// What it has written to stdout and stderr by now.
  [[nodiscard]] std::string out() const { return device_.empty() ? file_bytes(out_) : ""; }
  [[nodiscard]] std::string err() const { return file_bytes(err_); }

  void send(int signal) const { kill(child_, signal); }

  /// Whether it has ended; once it has, `wait` returns at once.
  bool ended() {
    if (!ended_) ended_ = waitpid(child_, &status_, WNOHANG) == child_;
    return ended_;
  }

  /// Waits for its end; when the limit is over it is killed.
  ProgramResult wait(std::chrono::seconds limit) {
    ProgramResult result;
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (!ended()) {
      if (!result.timed_out && std::chrono::steady_clock::now() > deadline) {
        send(SIGKILL);
        result.timed_out = true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (WIFEXITED(status_)) result.exit_code = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) result.signal = WTERMSIG(status_);
    result.out = out();
    result.err = err();
    return result;
  }

 private:
  TempFolder folder_;
  std::string device_;
  std::string out_;
  std::string err_;
  pid_t child_ = 0;
  int status_ = 0;
  bool ended_ = false;
};

/// Runs the taut program with these arguments and waits for it, a minute at most.
inline ProgramResult run_taut(const std::vector<std::string>& arguments, const std::string& device = "",
                              const std::string& input = "/dev/null") {
  return RunningProgram(arguments, device, input).wait(std::chrono::seconds(60));
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace taut::test
