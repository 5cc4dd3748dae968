#include "io/text_reader.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

namespace taut::detail {
namespace {

/// Did a literal that `from_chars` found out of range fall below the smallest double rather than above the largest?
bool underflows(std::string_view literal) {
  if (const auto e = literal.find_first_of("eE"); e != std::string_view::npos) {
    return e + 1 < literal.size() && literal[e + 1] == '-';
  }
  const auto digit = literal.find_first_of("123456789.");
  return digit != std::string_view::npos && literal[digit] == '.';
}

}  // namespace

NumberProblem parse_number(const char*& p, const char* end, double& value) {
  const char* start = p;
  if (start != end && *start == '+' && start + 1 != end && start[1] != '-') ++start;
  const auto [stop, error] = std::from_chars(start, end, value);
  if (error == std::errc::invalid_argument) return NumberProblem::not_a_number;
  if (error == std::errc::result_out_of_range) {
    if (!underflows({start, static_cast<std::size_t>(stop - start)})) return NumberProblem::too_large;
    value = 0;
  }
  p = stop;
  return NumberProblem::none;
}

TextReader::TextReader(const InputFile& file, char comment, std::size_t offset, std::size_t line)
    : file_(file),
      next_(file.bytes.data() + offset),
      end_(file.bytes.data() + file.bytes.size()),
      lines_begun_(line - 1),
      comment_(comment) {}

bool TextReader::next_line() {
  while (next_ != end_) {
    p_ = next_;
    const auto length = static_cast<std::size_t>(end_ - next_);
    const auto* feed = static_cast<const char*>(std::memchr(p_, '\n', length));
    line_end_ = feed == nullptr ? end_ : feed;
    next_ = feed == nullptr ? end_ : feed + 1;
    if ((++lines_begun_ & 0xFFFF) == 0) file_.context.check_cancelled();
    if (comment_ != 0) {
      const auto* mark = static_cast<const char*>(std::memchr(p_, comment_, static_cast<std::size_t>(line_end_ - p_)));
      if (mark != nullptr) line_end_ = mark;
    }
    if (!line_is_done()) {
      line_ = lines_begun_;
      return true;
    }
  }
  return false;
}

std::string_view TextReader::rest() {
  if (line_is_done()) return {};
  const char* last = line_end_;
  while (last != p_ && is_blank(last[-1])) --last;
  return {p_, static_cast<std::size_t>(last - p_)};
}

bool TextReader::line_is_done() {
  while (p_ != line_end_ && is_blank(*p_)) ++p_;
  return p_ == line_end_;
}

std::string_view TextReader::word() {
  if (line_is_done()) return {};
  const char* start = p_;
  while (p_ != line_end_ && !is_blank(*p_)) ++p_;
  return {start, static_cast<std::size_t>(p_ - start)};
}

double TextReader::number(std::string_view what) {
  if (line_is_done()) fail(std::string(what) + " is missing; the line is too short");
  const char* start = p_;
  double value = 0;
  const NumberProblem problem = parse_number(p_, line_end_, value);
  if (problem != NumberProblem::none || (p_ != line_end_ && !is_blank(*p_))) fail_number(start, problem, what);
  return value;
}

double TextReader::coordinate(std::string_view what) {
  const double value = number(what);
  if (!std::isfinite(value)) {
    fail(std::string(what) + " is " + (std::isnan(value) ? "nan" : "infinite") +
         "; remove the point or give it a finite value");
  }
  return value;
}

std::int64_t TextReader::integer(std::string_view what) {
  constexpr double kLargest = 9007199254740992.0;  // 2^53: every whole number up to here is a double
  const char* start = line_is_done() ? nullptr : p_;
  const double value = number(what);
  if (!(std::abs(value) <= kLargest) || value != std::floor(value)) {
    fail(std::string(what) + ": " + quote({start, static_cast<std::size_t>(p_ - start)}) +
         " is not a whole number; correct it");
  }
  return static_cast<std::int64_t>(value);
}

void TextReader::fail_number(const char* start, NumberProblem problem, std::string_view what) const {
  const char* stop = start;
  while (stop != line_end_ && !is_blank(*stop)) ++stop;
  const std::string_view word(start, static_cast<std::size_t>(stop - start));
  std::string message(what);
  message += ": " + quote(word);
  if (problem == NumberProblem::too_large) {
    message += " is too large for a double; rescale the data";
  } else if (word.find(',') != std::string_view::npos) {
    message += " is not a number; write decimals with a point and separate columns by blanks";
  } else {
    message += " is not a number; correct the line";
  }
  fail(message);
}

}  // namespace taut::detail
