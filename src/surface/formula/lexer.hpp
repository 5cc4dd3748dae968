#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace taut::detail {

enum class TokenKind : std::uint8_t {
  number,
  name,
  plus,
  minus,
  times,
  divide,
  power,
  open,
  close,
  comma,
  semicolon,
  equal,
  at_least,  // >= and >: a domain is closed, so both mean the same
  at_most,   // <= and <
  end,
};

struct Token {
  TokenKind kind = TokenKind::end;
  std::size_t column = 0;  // byte offset
  std::string_view text;
  double number = 0;
};

/// Cuts a formula into tokens, one at a time. Throws ParseError for what no token starts with and for numbers that a
/// double cannot hold.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}
  Token next();
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  Token number();
  [[noreturn]] void unexpected() const;

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace taut::detail
