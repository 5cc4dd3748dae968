#include "surface/formula/lexer.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "surface/formula/diagnostic.hpp"

namespace taut::detail {
namespace {

// <cctype> follows the locale; formulas do not.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Signs that mean what an ASCII sign or a name means: what editors, web pages and PDF files make of it.
struct Symbol {
  std::string_view spelling;
  TokenKind kind;
  std::string_view name = {};
};
constexpr Symbol kSymbols[] = {
    {"+", TokenKind::plus},          {"-", TokenKind::minus},           {"\u2212", TokenKind::minus},  // minus sign
    {"\u2010", TokenKind::minus},                                                                      // hyphen
    {"\u2011", TokenKind::minus},  // hyphen that does not break
    {"\u2013", TokenKind::minus},  // en dash
    {"**", TokenKind::power},        {"^", TokenKind::power},           {"*", TokenKind::times},
    {"\u00B7", TokenKind::times},                                    // middle dot
    {"\u22C5", TokenKind::times},                                    // dot operator
    {"\u2219", TokenKind::times},                                    // bullet operator
    {"\u00D7", TokenKind::times},                                    // multiplication sign
    {"\u2217", TokenKind::times},                                    // asterisk operator
    {"/", TokenKind::divide},        {"\u00F7", TokenKind::divide},  // division sign
    {"\u2215", TokenKind::divide},                                   // division slash
    {"\u2044", TokenKind::divide},                                   // fraction slash
    {"(", TokenKind::open},          {")", TokenKind::close},           {"|", TokenKind::bar},
    {",", TokenKind::comma},         {";", TokenKind::semicolon},       {"==", TokenKind::equal},
    {"=", TokenKind::equal},         {">=", TokenKind::at_least},       {">", TokenKind::at_least},
    {"\u2265", TokenKind::at_least}, {"<=", TokenKind::at_most},        {"<", TokenKind::at_most},
    {"\u2264", TokenKind::at_most},  {"\u03C0", TokenKind::name, "pi"}, {"\u221A", TokenKind::name, "sqrt"},
};

constexpr std::string_view kSpaces[] = {" ",      "\t",     "\n",     "\r",     "\f",    "\v",
                                        "\u00A0", "\u2009", "\u202F", "\u200B", "\uFEFF"};

constexpr std::string_view kRaised[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                        "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
constexpr std::string_view kRaisedMinus = "\u207B";

/// The digit that stands raised at the start of `text`; -1 if none does.
int raised_digit(std::string_view text) {
  for (int digit = 0; digit < 10; ++digit) {
    if (text.starts_with(kRaised[digit])) return digit;
  }
  return -1;
}

std::size_t space_length(std::string_view text) {
  for (const std::string_view space : kSpaces) {
    if (text.starts_with(space)) return space.size();
  }
  return 0;
}

}  // namespace

std::size_t letter_length(std::string_view text, std::size_t at) {
  if (at >= text.size()) return 0;
  if (is_letter(text[at])) return 1;
  const std::string_view two = text.substr(at, 2);
  const bool greek = (two >= "\u0391" && two <= "\u03A9") || (two >= "\u03B1" && two <= "\u03C9");
  return two.size() == 2 && greek && two != "\u03C0" ? 2 : 0;
}

bool is_name(std::string_view text) {
  std::size_t at = letter_length(text, 0);
  if (at == 0) return false;
  while (at < text.size()) {
    const std::size_t length = is_digit(text[at]) ? 1 : letter_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

Token Lexer::next() {
  while (const std::size_t length = space_length(text_.substr(at_))) at_ += length;
  const std::size_t begin = at_;
  const std::string_view rest = text_.substr(begin);
  if (rest.empty()) return {TokenKind::end, begin, begin, rest};
  if (is_digit(rest[0]) || (rest.size() > 1 && rest[0] == '.' && is_digit(rest[1]))) return number();
  if (rest.starts_with(kRaisedMinus) || raised_digit(rest) >= 0) return superscript();
  if (letter_length(text_, begin) > 0) {
    while (at_ < text_.size()) {
      const std::size_t length = is_digit(text_[at_]) ? 1 : letter_length(text_, at_);
      if (length == 0) break;
      at_ += length;
    }
    return {TokenKind::name, begin, at_, text_.substr(begin, at_ - begin)};
  }
  for (const Symbol& symbol : kSymbols) {
    if (!rest.starts_with(symbol.spelling)) continue;
    at_ += symbol.spelling.size();
    return {symbol.kind, begin, at_, symbol.name.empty() ? rest.substr(0, symbol.spelling.size()) : symbol.name};
  }
  unexpected();
}

Token Lexer::shorten(const Token& token, std::size_t length) {
  at_ = token.column + length;
  return {token.kind, token.column, at_, token.text.substr(0, length)};
}

Token Lexer::superscript() {
  const std::size_t begin = at_;
  const bool minus = text_.substr(at_).starts_with(kRaisedMinus);
  if (minus) at_ += kRaisedMinus.size();
  double value = 0;
  const std::size_t first = at_;
  for (int digit = 0; (digit = raised_digit(text_.substr(at_))) >= 0; at_ += kRaised[digit].size()) {
    value = 10 * value + digit;
  }
  if (at_ == first) throw parse_error(text_, begin, "a raised minus without raised digits: write ^(-...)");
  return {TokenKind::superscript, begin, at_, text_.substr(begin, at_ - begin), minus ? -value : value};
}

Token Lexer::number() {
  const std::size_t begin = at_;
  std::size_t end = at_;
  const auto digits = [&] {
    while (end < text_.size() && is_digit(text_[end])) ++end;
  };
  digits();
  if (end < text_.size() && text_[end] == '.') {
    ++end;
    digits();
  }
  // An exponent needs a digit: in `2e + x` the e is Euler's number.
  if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
    std::size_t first = end + 1;
    if (first < text_.size() && (text_[first] == '+' || text_[first] == '-')) ++first;
    if (first < text_.size() && is_digit(text_[first])) {
      end = first;
      digits();
    }
  }
  const std::string_view spelling = text_.substr(begin, end - begin);
  Token token{TokenKind::number, begin, end, spelling};
  const std::errc error = std::from_chars(spelling.data(), spelling.data() + spelling.size(), token.number).ec;
  if (error == std::errc::result_out_of_range) {
    throw parse_error(text_, begin,
                      "the number " + quoted(spelling) + " is outside the range of double (about 2e-308 to 1.8e308)");
  }
  if (end < text_.size() && text_[end] == '.') {
    throw parse_error(text_, end, "a number with two decimal points");
  }
  at_ = end;
  return token;
}

void Lexer::unexpected() const {
  static constexpr std::pair<std::string_view, std::string_view> kHints[] = {
      {"[", "use parentheses"},
      {"]", "use parentheses"},
      {"{", "use parentheses"},
      {"}", "use parentheses"},
      {"!", "there is no factorial, and != cuts nothing"},
      {"%", "there is no remainder"},
      {"\\", "LaTeX is not read; write * / ^ sqrt(...)"},
      {"$", "LaTeX is not read; write * / ^ sqrt(...)"},
      {"\u221B", "write cbrt(...)"},
      {"\u00B1", "write one sign, or square both sides"},
      {"\u2208", "a domain is made of inequalities"},
      {"\xE2\x82", "write lowered digits as plain ones, x1 for the first variable"},  // U+2080 ...
      {"\xF0\x9D", "type it as a plain letter"},             // U+1D400 ...: mathematical letters
      {"\xD1\x85", "it only looks like x; type a plain x"},  // Cyrillic
      {"\xD1\x83", "it only looks like y; type a plain y"},
      {"\"", "leave the quotes out"},
      {"'", "leave the quotes out"},
      {"\xE2\x80\x98", "leave the quotes out"},
      {"\xE2\x80\x99", "leave the quotes out"},
      {"\xE2\x80\x9C", "leave the quotes out"},
      {"\xE2\x80\x9D", "leave the quotes out"},
      {"\u2032", "there are no derivatives in a formula"},
  };
  const std::string_view rest = text_.substr(at_);
  std::size_t length = 1;
  while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0) == 0x80) ++length;
  std::string shown(rest.substr(0, length));
  for (const auto& [symbol, hint] : kHints) {
    if (!rest.starts_with(symbol)) continue;
    throw parse_error(text_, at_, quoted(shown).append(" is not understood: ").append(hint));
  }
  if (static_cast<unsigned char>(rest[0]) < 0x20 || rest[0] == 0x7f) {
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(rest[0])));
    shown = code;
  }
  throw parse_error(text_, at_, "the character " + quoted(shown) + " means nothing in a formula");
}

}  // namespace taut::detail
