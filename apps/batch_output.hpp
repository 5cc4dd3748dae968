#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace taut::app {

/// The lines a batch answers with, kept as they come, so that a batch that was stopped goes on where it was: they go to
/// FILE.partial, under a first line that says what was asked for, and become FILE when all are there. Without a file
/// they go to stdout.
class BatchOutput {
 public:
  /// To stdout, below `header`, a line of column names; empty for none.
  explicit BatchOutput(const std::string& header);
  /// To `file`, below `header`. `request`: one line that stands for the whole command; lines of an earlier run are kept
  /// if theirs was the same. Throws IoError.
  BatchOutput(const std::filesystem::path& file, std::string_view request, std::string header);
  BatchOutput(const BatchOutput&) = delete;
  BatchOutput& operator=(const BatchOutput&) = delete;
  ~BatchOutput();

  /// Lines that an earlier run has left, and whether the fifth column of one of them is another status than "ok".
  [[nodiscard]] std::size_t num_done() const { return num_done_; }
  [[nodiscard]] bool some_failed() const { return some_failed_; }
  [[nodiscard]] std::filesystem::path partial() const { return partial_; }

  /// Whole lines. They are on their way to the disk when it returns. Throws IoError.
  void write(std::string_view lines);
  /// All lines are there.
  void finish();

 private:
  void read_earlier(std::string_view header);

  std::filesystem::path file_;
  std::filesystem::path partial_;
  std::string header_;
  std::FILE* out_ = nullptr;  // null: stdout
  std::size_t num_done_ = 0;
  bool some_failed_ = false;
};

}  // namespace taut::app
