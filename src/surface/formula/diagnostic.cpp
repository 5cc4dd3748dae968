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
  std::size_t begin = column > kWindowBefore ? column - kWindowBefore : 0;
  std::size_t end = std::min(text.size(), column + kWindowAfter);
  while (begin > 0 && continues_character(text[begin])) --begin;
  while (end < text.size() && continues_character(text[end])) ++end;

  std::string line = begin > 0 ? "..." : "";
  std::size_t caret = line.size();
  for (std::size_t i = begin; i < end; ++i) {
    const bool control = static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7f;
    line += control ? ' ' : text[i];
    if (i < column && !continues_character(text[i])) ++caret;
  }
  if (end < text.size()) line += "...";
  return ParseError(reason + "\n  " + line + "\n  " + std::string(caret, ' ') + "^", column);
}

}  // namespace taut::detail
