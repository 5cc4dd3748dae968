#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace taut::detail {

/// Reads lines of numbers separated by commas, semicolons, or blanks; which of them, the first line decides.
class RowParser {
 public:
  /// Looks for the separator in the first line: a semicolon, else a comma, else blanks.
  void choose_separator(std::string_view first_line);
  /// Reads only these columns (from 0), in this order, and skips the others, which may hold any text. Without a call,
  /// all columns are read.
  void select(std::vector<std::size_t> columns);

  /// Appends the numbers of `line` to `values`. Returns what is wrong, empty if nothing is.
  [[nodiscard]] std::string parse(std::string_view line, std::vector<double>& values) const;
  /// The fields of `line`, blanks and quotes around them removed.
  [[nodiscard]] std::vector<std::string_view> split(std::string_view line) const;

 private:
  [[nodiscard]] std::string parse_selected(std::string_view line, std::vector<double>& values) const;
  [[nodiscard]] std::string explain(std::string_view line, std::size_t column) const;

  char separator_ = ' ';
  std::vector<std::size_t> columns_;
};

/// Does this look like a line of column names? It does when not every field is a number (nan and inf included) and none
/// begins like one.
[[nodiscard]] bool is_header(const std::vector<std::string_view>& fields);

/// Which columns of a table are coordinates and which are normals.
struct ColumnRoles {
  std::vector<std::size_t> coordinates;
  std::vector<std::size_t> normals;  ///< as many as coordinates, or none
  std::vector<std::size_t> others;
  bool named = false;  ///< the header has at least one of the names below
};

/// Reads the roles from column names: x y z w or x1 x2 ... for coordinates, nx ny nz (normal_x ...) or n1 n2 ... for
/// normals, in any order and case. A header without any of these names makes every column a coordinate.
[[nodiscard]] ColumnRoles roles_from_header(const std::vector<std::string_view>& names);

}  // namespace taut::detail
