#pragma once

// Is what a page shows what the program prints? Words have to be the same, blanks between them may differ. Numbers have
// to agree to the digits shown, and to nine digits where more are shown: processors may differ in the last ones.
// Estimates (2.3e-10) have to be of the same order. "..." at the end stands for the rest of a line. Of lines with times
// only the first word counts.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace taut::test {

/// A piece of a line: a number, or the words between two numbers.
struct Piece {
  std::string text;
  bool number = false;
};

/// Length of the number that `text` begins with, 0 = none. Commas are part of it between groups of three digits.
inline std::size_t number_length(std::string_view text) {
  const auto digit = [&](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  const auto sign = [&](std::size_t i) { return i < text.size() && (text[i] == '-' || text[i] == '+'); };
  std::size_t i = sign(0) ? 1 : 0;
  if (!digit(i) && !(i < text.size() && text[i] == '.' && digit(i + 1))) return 0;
  while (digit(i) ||
         (i < text.size() && text[i] == ',' && digit(i + 1) && digit(i + 2) && digit(i + 3) && !digit(i + 4))) {
    ++i;
  }
  if (i < text.size() && text[i] == '.') {
    ++i;
    while (digit(i)) ++i;
  }
  if (i < text.size() && text[i] == 'e' && digit(sign(i + 1) ? i + 2 : i + 1)) {
    i += sign(i + 1) ? 2 : 1;
    while (digit(i)) ++i;
  }
  return i;
}

/// Blanks at both ends are dropped, others become one.
inline std::vector<Piece> pieces_of(const std::string& line) {
  std::vector<Piece> pieces(1);
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t length = number_length(std::string_view(line).substr(i));
    if (length > 0) {
      pieces.push_back({line.substr(i, length), true});
      pieces.emplace_back();
      i += length;
    } else {
      std::string& words = pieces.back().text;
      if (line[i] != ' ' || (!words.empty() && words.back() != ' ')) words += line[i];
      ++i;
    }
  }
  for (Piece& piece : pieces) {
    while (piece.text.ends_with(' ')) piece.text.pop_back();
  }
  return pieces;
}

inline bool same_number(std::string shown, std::string printed) {
  std::erase(shown, ',');
  std::erase(printed, ',');
  const double x = std::strtod(shown.c_str(), nullptr);
  const double y = std::strtod(printed.c_str(), nullptr);
  const std::size_t exponent = shown.find('e');
  constexpr double kNegligible = 1e-6;
  if (exponent != std::string::npos && std::abs(x) < 1e-2) {
    if (std::abs(x) < kNegligible) return std::abs(y) < kNegligible;
    return y / x > 0.1 && y / x < 10;
  }
  const std::string mantissa = shown.substr(0, exponent);
  const std::size_t point = mantissa.find('.');
  double unit = 0;  // of the last digit shown; whole numbers have to be the same
  if (point != std::string::npos) unit = std::pow(10.0, -static_cast<double>(mantissa.size() - point - 1));
  if (exponent != std::string::npos) {
    unit = std::max(unit, point == std::string::npos ? 1.0 : 0.0) * std::pow(10.0, std::atoi(&shown[exponent + 1]));
  }
  return std::abs(x - y) <= std::max(unit, 1e-9 * std::abs(x));
}

inline bool same_line(std::string shown, const std::string& printed) {
  constexpr std::array<std::string_view, 3> kTimes = {"time ", "took ", "pictures "};
  for (const std::string_view word : kTimes) {
    if (shown.starts_with(word)) return printed.starts_with(word);
  }
  const bool cut = shown.ends_with("...");
  if (cut) shown.resize(shown.size() - 3);
  const std::vector<Piece> want = pieces_of(shown);
  const std::vector<Piece> have = pieces_of(printed);
  if (cut ? have.size() < want.size() : have.size() != want.size()) return false;
  for (std::size_t i = 0; i < want.size(); ++i) {
    if (want[i].number != have[i].number) return false;
    if (want[i].number) {
      if (!same_number(want[i].text, have[i].text)) return false;
    } else if (cut && i + 1 == want.size() ? !have[i].text.starts_with(want[i].text) : want[i].text != have[i].text) {
      return false;
    }
  }
  return true;
}

/// The first line shown that is printed neither on stdout nor on stderr behind those shown before it; empty = none.
inline std::string first_missing(const std::vector<std::string>& shown, const std::vector<std::string>& out,
                                 const std::vector<std::string>& err) {
  auto next_out = out.begin();
  auto next_err = err.begin();
  for (const std::string& line : shown) {
    if (line == "...") continue;
    const auto same = [&](const std::string& printed) { return same_line(line, printed); };
    if (const auto found = std::find_if(next_out, out.end(), same); found != out.end()) {
      next_out = found + 1;
    } else if (const auto noted = std::find_if(next_err, err.end(), same); noted != err.end()) {
      next_err = noted + 1;
    } else {
      return line;
    }
  }
  return "";
}

}  // namespace taut::test
