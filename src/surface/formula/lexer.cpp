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
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

}  // namespace

Token Lexer::next() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  const std::size_t begin = at_;
  const auto token = [&](TokenKind kind, std::size_t length) {
    at_ += length;
    return Token{kind, begin, text_.substr(begin, length)};
  };
  if (at_ == text_.size()) return token(TokenKind::end, 0);
  const char c = text_[at_];
  const char following = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
  if (is_digit(c) || (c == '.' && is_digit(following))) return number();
  if (is_letter(c)) {
    std::size_t length = 1;
    while (begin + length < text_.size() && (is_letter(text_[begin + length]) || is_digit(text_[begin + length]))) {
      ++length;
    }
    return token(TokenKind::name, length);
  }
  switch (c) {
    case '+': return token(TokenKind::plus, 1);
    case '-': return token(TokenKind::minus, 1);
    case '*':
      if (following == '*') throw parse_error(text_, begin, "'**' is not an operator: write ^ for powers");
      return token(TokenKind::times, 1);
    case '/': return token(TokenKind::divide, 1);
    case '^': return token(TokenKind::power, 1);
    case '(': return token(TokenKind::open, 1);
    case ')': return token(TokenKind::close, 1);
    case ',': return token(TokenKind::comma, 1);
    case ';': return token(TokenKind::semicolon, 1);
    case '=':
      if (following == '=') throw parse_error(text_, begin, "'==' is not an operator: write = once");
      return token(TokenKind::equal, 1);
    case '>': return token(TokenKind::at_least, following == '=' ? 2 : 1);
    case '<': return token(TokenKind::at_most, following == '=' ? 2 : 1);
    default: unexpected();
  }
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
  Token token{TokenKind::number, begin, spelling};
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
      {"\xC2\xB2", "write ^2"},      {"\xC2\xB3", "write ^3"},     {"\xE2\x88\x92", "write -"},
      {"\xE2\x80\x93", "write -"},   {"\xC2\xB7", "write *"},      {"\xC3\x97", "write *"},
      {"\xE2\x8B\x85", "write *"},   {"\xC3\xB7", "write /"},      {"\xCF\x80", "write pi"},
      {"\xE2\x89\xA5", "write >="},  {"\xE2\x89\xA4", "write <="}, {"\xE2\x88\x9A", "write sqrt(...)"},
      {"[", "use parentheses"},      {"]", "use parentheses"},     {"{", "use parentheses"},
      {"}", "use parentheses"},      {"|", "write abs(...)"},      {"!", "there is no factorial"},
      {"%", "there is no remainder"}};
  const std::string_view rest = text_.substr(at_);
  for (const auto& [symbol, hint] : kHints) {
    if (!rest.starts_with(symbol)) continue;
    throw parse_error(text_, at_, quoted(symbol).append(" is not understood: ").append(hint));
  }
  std::size_t length = 1;
  while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0) == 0x80) ++length;
  std::string shown(rest.substr(0, length));
  if (static_cast<unsigned char>(rest[0]) < 0x20 || rest[0] == 0x7f) {
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(rest[0])));
    shown = code;
  }
  throw parse_error(text_, at_, "the character " + quoted(shown) + " means nothing in a formula");
}

}  // namespace taut::detail
