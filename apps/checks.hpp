#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace taut::app {

// Checks of option values. Each says what may be written there, in its error and in --help.

/// A finite number in [least, most]; `rule` says so in words, and `hint` beside the option in --help.
[[nodiscard]] inline CLI::Validator number_check(double least, double most, const std::string& rule,
                                                 const std::string& hint) {
  const auto check = [least, most, rule](std::string& text) -> std::string {
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    return is_number && value >= least && value <= most ? "" : fmt::format("'{}' is not {}", text, rule);
  };
  return CLI::Validator(check, hint);
}

[[nodiscard]] inline CLI::Validator any_number() {
  return number_check(std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(), "a finite number", "");
}

[[nodiscard]] inline CLI::Validator positive_number() {
  return number_check(std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(),
                      "a positive number", "> 0");
}

[[nodiscard]] inline CLI::Validator number_not_below_zero() {
  return number_check(0, std::numeric_limits<double>::max(), "zero or a positive number", ">= 0");
}

[[nodiscard]] inline CLI::Validator number_between(double least, double most) {
  return number_check(least, most, fmt::format("a number from {} to {}", least, most),
                      fmt::format("{}..{}", least, most));
}

/// A whole number from `least` to `most`.
[[nodiscard]] inline CLI::Validator whole_number(long long least, long long most) {
  const auto check = [least, most](std::string& text) -> std::string {
    long long value = 0;
    const bool is_whole = CLI::detail::lexical_cast(text, value);
    return is_whole && value >= least && value <= most
               ? ""
               : fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
  return CLI::Validator(check, fmt::format("{}..{}", least, most));
}

/// One of these names, which stand for values of an enumeration.
template <class Enum>
[[nodiscard]] CLI::Validator one_of(const std::vector<std::pair<std::string, Enum>>& names) {
  std::string list;
  for (const auto& [name, value] : names) list += (list.empty() ? "" : ", ") + name;
  const auto translate = [names, list](std::string& text) -> std::string {
    for (const auto& [name, value] : names) {
      if (name != text) continue;
      text = std::to_string(static_cast<int>(value));
      return "";
    }
    return fmt::format("'{}' is none of {}", text, list);
  };
  return CLI::Validator(translate, list);
}

}  // namespace taut::app
