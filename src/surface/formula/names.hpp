#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "surface/formula/expression.hpp"
#include "surface/formula/lexer.hpp"
#include "taut/core/error.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

struct Function {
  std::string_view name;
  Op op;
  int min_arguments;
  int max_arguments;  // min and max fold any number
};

/// The function called `name`, or null.
[[nodiscard]] const Function* find_function(std::string_view name);

/// What the names in a formula mean: variables, parameters, pi and e.
class Names {
 public:
  /// `dim` as the user asked for it. Throws InvalidArgument when a parameter is not finite, not a name, or already
  /// means something.
  Names(const std::map<std::string, double>& parameters, std::optional<Index> dim);

  /// Variable (from 0) that `token` names, if it does. Throws ParseError for x0, for more than dim, and where letters
  /// x y z w and numbered variables are mixed.
  std::optional<std::uint32_t> variable(std::string_view text, const Token& token);

  /// The value of a parameter or of pi, e.
  [[nodiscard]] std::optional<double> value(std::string_view name) const;

  /// Explains why `token` is unknown, with the nearest name that is known.
  [[nodiscard]] ParseError unknown(std::string_view text, const Token& token) const;

  /// 1 + the largest variable seen so far; 0 = none.
  [[nodiscard]] Index variables_used() const { return variables_used_; }

 private:
  enum class Style { undecided, letters, numbers };

  const std::map<std::string, double>* parameters_;
  std::optional<Index> dim_;
  Style style_ = Style::undecided;
  Index variables_used_ = 0;
};

}  // namespace taut::detail
