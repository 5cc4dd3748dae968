#include "surface/formula/diagnostic.hpp"

#include <algorithm>

namespace taut::detail {
namespace {

constexpr std::size_t kWindowBefore = 60;  // bytes shown before and after the caret
constexpr std::size_t kWindowAfter = 40;

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  result.append(text.substr(0, kLongest));
  if (text.size() > kLongest) result += "...";
  result += "'";
  return result;
}

ParseError parse_error(std::string_view text, std::size_t column, const std::string& reason) {
  column = std::min(column, text.size());
  // Of a formula that came from a file, the line.
  const std::size_t line_begin = column == 0 ? 0 : text.rfind('\n', column - 1) + 1;
  const std::size_t line_end = std::min(text.find('\n', column), text.size());
  std::size_t begin = std::max(line_begin, column > kWindowBefore ? column - kWindowBefore : 0);
  std::size_t end = std::min(line_end, column + kWindowAfter);
  while (begin > line_begin && continues_character(text[begin])) --begin;
  while (end < line_end && continues_character(text[end])) ++end;

  std::string line = begin > line_begin ? "..." : "";
  std::size_t caret = line.size();
  for (std::size_t i = begin; i < end; ++i) {
    const bool control = static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7f;
    line += control ? ' ' : text[i];
    if (i < column && !continues_character(text[i])) ++caret;
  }
  if (end < line_end) line += "...";
  return ParseError(reason + "\n  " + line + "\n  " + std::string(caret, ' ') + "^", column);
}

}  // namespace taut::detail
