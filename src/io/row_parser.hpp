#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Reads lines of numbers separated by commas, semicolons, tabs or blanks; which of them, the first line decides.
/// Values may stand in quotes. Decimal commas are read where they cannot be taken for separators: between semicolons,
/// tabs or quotes.
class RowParser {
 public:
  /// Looks for the separator in the first line: a semicolon, else a comma, else tabs where fields hold blanks, else
  /// blanks and tabs alike.
  void choose_separator(std::string_view first_line);
  /// Reads only these columns (from 0), in this order, and skips the others, which may hold any text. Without a call,
  /// all columns are read.
  void select(std::vector<std::size_t> columns);

  /// From now on a field such as @17 stands for the coordinates of this sample, counted from 0. Null: there are none.
  void set_samples(const Points* samples);

  /// Appends the numbers of `line` to `values`. Returns what is wrong, empty if nothing is.
  [[nodiscard]] std::string parse(std::string_view line, std::vector<double>& values);
  /// The fields of `line`, blanks and quotes around them removed.
  [[nodiscard]] std::vector<std::string_view> split(std::string_view line) const;

  [[nodiscard]] char separator() const { return separator_; }
  /// Has a line been read that writes decimals with a comma?
  [[nodiscard]] bool decimal_commas() const { return seen_comma_; }

 private:
  [[nodiscard]] std::string parse_fields(std::string_view line, std::vector<double>& values);
  [[nodiscard]] std::string append_sample(std::string_view field, std::vector<double>& values) const;
  [[nodiscard]] std::string explain(std::string_view line, std::size_t column) const;

  char separator_ = ' ';  // ' ' stands for blanks and tabs
  std::vector<std::size_t> columns_;
  const Points* samples_ = nullptr;
  bool seen_comma_ = false;  // decimal signs in fields between which a comma does not separate
  bool seen_point_ = false;
};

/// Does the field name a sample, as @17 does?
[[nodiscard]] bool is_sample(std::string_view field);

/// Is the field a number as files without decimal commas write it, nan and inf included?
[[nodiscard]] bool is_number(std::string_view field);

}  // namespace taut::detail
