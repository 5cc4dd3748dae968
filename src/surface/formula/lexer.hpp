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
  superscript,  // a raised whole number, as in x²
  open,
  close,
  bar,  // | opens or closes an absolute value
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
  std::size_t end = 0;     // byte offset behind it
  std::string_view text;   // its name: "pi" where π was written
  double number = 0;
};

/// How many bytes the letter at `at` has: a-z, A-Z, _ or a Greek letter other than π; 0 if none stands there.
[[nodiscard]] std::size_t letter_length(std::string_view text, std::size_t at);

/// Is this a letter, then letters and digits?
[[nodiscard]] bool is_name(std::string_view text);

/// Cuts a formula into tokens, one at a time. Throws ParseError for what no token starts with and for numbers that a
/// double cannot hold.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}
  Token next();
  /// Gives back all but the first `length` bytes of the name `token`, which was read last; returns what is left of it.
  Token shorten(const Token& token, std::size_t length);
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  Token number();
  Token superscript();
  [[noreturn]] void unexpected() const;

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace taut::detail
