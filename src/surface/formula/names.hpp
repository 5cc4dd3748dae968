#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  /// `variables` are the user's own, in order; empty stands for x y z w or x1 x2 .... `dim` as the user asked for it.
  /// Throws InvalidArgument when a variable or parameter is no name or already means something, and when a parameter is
  /// not finite.
  Names(const std::vector<std::string>& variables, const std::map<std::string, double>& parameters,
        std::optional<Index> dim);

  /// Variable (from 0) that `token` names, if it does. Throws ParseError for x0, for more than dim, and where letters
  /// x y z w and numbered variables are mixed.
  std::optional<std::uint32_t> variable(std::string_view text, const Token& token);

  /// Takes x, y and z for used: a body stands in space. False where the dimension asked for, or the number of the
  /// user's own variables, is less than 3.
  bool use_space();

  /// From now on `name` means `node`.
  void define(const std::string& name, NodeId node) { definitions_[name] = node; }
  [[nodiscard]] std::optional<NodeId> definition(std::string_view name) const;
  /// May `name` be defined: is it a name, and means nothing yet? Throws InvalidArgument where it may not.
  void check_definable(const std::string& name) const;

  /// The value of a parameter or of pi, e.
  [[nodiscard]] std::optional<double> value(std::string_view name) const;

  /// How many bytes of `name` are its first factor: of "xy", which means nothing by itself, one. All of a name that
  /// means something, or that is no product of variables.
  [[nodiscard]] std::size_t first_factor(std::string_view name) const;

  /// Explains why `token` is unknown, with the nearest name that is known.
  [[nodiscard]] UnknownName unknown(std::string_view text, const Token& token) const;

  /// 1 + the largest variable seen so far; 0 = none.
  [[nodiscard]] Index variables_used() const { return variables_used_; }

 private:
  enum class Style { undecided, letters, numbers };

  void check_new(const std::string& kind, const std::string& name) const;
  [[nodiscard]] std::optional<Index> own_variable(std::string_view name) const;

  const std::vector<std::string>* variables_;
  const std::map<std::string, double>* parameters_;
  std::optional<Index> dim_;
  std::map<std::string, NodeId, std::less<>> definitions_;
  Style style_ = Style::undecided;
  Index variables_used_ = 0;
};

}  // namespace taut::detail
