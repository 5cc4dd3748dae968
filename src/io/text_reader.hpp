#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/input_file.hpp"

namespace taut::detail {

/// How reading one number went.
enum class NumberProblem { none, not_a_number, too_large };

/// Reads a decimal number (also nan, inf, a leading plus) at the start of [p, end) and moves p past it. Independent of
/// the locale; a magnitude too small for a double becomes zero.
NumberProblem parse_number(const char*& p, const char* end, double& value);

[[nodiscard]] inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

/// Walks over a text line by line, and over a line word by word, and knows where it is when something is wrong. Lines
/// end in LF or CRLF; the last one needs no end. Blank lines are skipped.
class TextReader {
 public:
  /// `comment` starts a comment that runs to the end of its line; 0 = the format has none. Starts at byte `offset`,
  /// which lies on line `line`.
  TextReader(const InputFile& file, char comment, std::size_t offset = 0, std::size_t line = 1);

  /// Goes to the next line with a word on it; false at the end of the file.
  bool next_line();
  /// The rest of the current line, without comment and surrounding blanks.
  [[nodiscard]] std::string_view rest();
  [[nodiscard]] std::size_t line_number() const { return line_; }
  /// Bytes after the current line.
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - next_); }

  /// Is there no word left on this line?
  [[nodiscard]] bool line_is_done();
  /// The next word of the line, empty at its end.
  std::string_view word();
  /// The next word as a number. `what` ("coordinate x") stands in the error.
  double number(std::string_view what);
  /// A number that must be finite.
  double coordinate(std::string_view what);
  /// A whole number.
  std::int64_t integer(std::string_view what);

  [[noreturn]] void fail(const std::string& problem) const { file_.fail_at_line(line_, problem); }
  /// For a file that ends too early.
  [[noreturn]] void fail_at_end(const std::string& problem) const { file_.fail_at_line(lines_begun_, problem); }

 private:
  [[noreturn]] void fail_number(const char* start, NumberProblem problem, std::string_view what) const;

  const InputFile& file_;
  const char* next_;         // start of the line after the current one
  const char* end_;          // of the text
  const char* p_ = nullptr;  // next character of the current line
  const char* line_end_ = nullptr;
  std::size_t line_ = 0;         // number of the current line, from 1
  std::size_t lines_begun_ = 0;  // number of the last line looked at
  char comment_;
};

}  // namespace taut::detail
