#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::paper {

/// One entry of a table. Nothing = there is no such number, shown as a dash and written as an empty field.
using Value = std::variant<std::monostate, std::string, double, Index>;

struct Column {
  std::string name;               ///< as shown above it, with its unit: "length", "time, s"
  std::string format = "{:.6g}";  ///< of its numbers in the report; files have every digit
};

/// Numbers for people (HTML) and for programs (CSV, JSON).
struct Table {
  std::string name;   ///< of its files, without extension: "figure5_lengths"
  std::string title;  ///< the sentence above it
  std::vector<Column> columns;
  std::vector<std::vector<Value>> rows = {};  ///< each as long as `columns`

  void add(std::vector<Value> row) { rows.push_back(std::move(row)); }
};

[[nodiscard]] std::string to_html(const Table& table);
/// A header of the columns' names, then a line a row (RFC 4180).
[[nodiscard]] std::string to_csv(const Table& table);
/// {"title": ..., "rows": [{column: value, ...}, ...]}
[[nodiscard]] nlohmann::ordered_json to_json(const Table& table);

/// Text as it may stand in HTML and SVG: & < > " are written as entities.
[[nodiscard]] std::string escape_markup(std::string_view text);

/// A number as people write it, in HTML: 1.2e-05 becomes 1.2 x 10^-5 with a raised exponent.
[[nodiscard]] std::string readable_number(double value, const std::string& format);

}  // namespace taut::paper
