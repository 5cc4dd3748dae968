#include "io/header_fields.hpp"

#include <algorithm>
#include <cmath>

#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string plain_key(std::string_view key) {
  std::string plain = lower(key);
  std::erase_if(plain, is_blank);
  return plain;
}

bool separates(char c) { return is_blank(c) || c == ',' || c == '(' || c == ')'; }

}  // namespace

void HeaderFields::add(std::string_view line_text, std::string_view separator, std::size_t line) {
  const auto at = line_text.find(separator);
  if (at == std::string_view::npos) return;
  entries_.push_back({.key = plain_key(line_text.substr(0, at)),
                      .value = std::string(trimmed(line_text.substr(at + separator.size()))),
                      .line = line});
}

const HeaderFields::Entry* HeaderFields::entry(std::string_view key) const {
  const std::string wanted = plain_key(key);
  const auto found = std::ranges::find(entries_, wanted, &Entry::key);
  return found == entries_.end() ? nullptr : &*found;
}

const std::string* HeaderFields::find(std::string_view key, std::string_view other) const {
  const Entry* found = entry(key);
  if (found == nullptr && !other.empty()) found = entry(other);
  return found == nullptr ? nullptr : &found->value;
}

const std::string& HeaderFields::at(std::string_view key) const {
  if (const std::string* value = find(key)) return *value;
  file_.fail("the header has no entry " + quote(key) + "; the file is damaged or no volume");
}

void HeaderFields::fail(std::string_view key, const std::string& problem) const {
  const Entry* found = entry(key);
  const std::string message = quote(key) + ": " + problem;
  if (found == nullptr) file_.fail(message);
  file_.fail_at_line(found->line, message);
}

std::vector<double> HeaderFields::numbers(std::string_view key, std::string_view other) const {
  const std::string* value = find(key, other);
  std::vector<double> list;
  if (value == nullptr) return list;
  const char* p = value->data();
  const char* end = p + value->size();
  while (true) {
    while (p != end && separates(*p)) ++p;
    if (p == end) return list;
    double number = 0;
    if (parse_number(p, end, number) != NumberProblem::none || (p != end && !separates(*p))) {
      fail(key, quote(*value) + " are not all numbers; correct the header");
    }
    list.push_back(number);
  }
}

std::vector<double> HeaderFields::numbers(std::string_view key, std::size_t count, std::string_view other) const {
  std::vector<double> list = numbers(key, other);
  if (list.empty() && find(key, other) == nullptr) return list;
  if (list.size() != count) {
    fail(key, counted(list.size(), "number") + " where " + std::to_string(count) + " are needed; correct the header");
  }
  for (const double number : list) {
    if (!std::isfinite(number)) fail(key, "a number is not finite; correct the header");
  }
  return list;
}

std::vector<std::int64_t> HeaderFields::integers(std::string_view key, std::size_t count) const {
  constexpr double kLargest = 9007199254740992.0;  // 2^53: every whole number up to here is a double
  static_cast<void>(at(key));
  std::vector<std::int64_t> list;
  for (const double number : numbers(key, count)) {
    if (!(std::abs(number) <= kLargest) || number != std::floor(number)) {
      fail(key, "a number is not whole; correct the header");
    }
    list.push_back(static_cast<std::int64_t>(number));
  }
  return list;
}

}  // namespace taut::detail
