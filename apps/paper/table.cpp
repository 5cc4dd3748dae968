#include "table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "taut/io/output_file.hpp"

namespace taut::paper {
namespace {

std::string csv_field(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
  if (const auto* count = std::get_if<Index>(&value)) return std::to_string(*count);
  if (!std::holds_alternative<std::string>(value)) return "";
  const std::string& text = std::get<std::string>(value);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

nlohmann::ordered_json json_value(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    // JSON knows no infinity and no NaN.
    if (!std::isfinite(*number)) return shortest(*number);
    return *number;
  }
  if (const auto* count = std::get_if<Index>(&value)) return *count;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;
}

/// 1234567 as 1,234,567.
std::string grouped_digits(Index count) {
  std::string digits = std::to_string(std::abs(count));
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3) {
    digits.insert(static_cast<std::size_t>(i), ",");
  }
  return (count < 0 ? "−" : "") + digits;
}

std::string html_cell(const Value& value, const Column& column) {
  if (const auto* number = std::get_if<double>(&value)) {
    return "<td class=\"number\">" + readable_number(*number, column.format) + "</td>";
  }
  if (const auto* count = std::get_if<Index>(&value)) {
    return "<td class=\"number\">" + grouped_digits(*count) + "</td>";
  }
  if (const auto* text = std::get_if<std::string>(&value)) return "<td>" + escape_markup(*text) + "</td>";
  return "<td class=\"number\">–</td>";
}

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string readable_number(double value, const std::string& format) {
  if (std::isnan(value)) return "–";
  if (value == 0) return "0";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  std::string text = fmt::format(fmt::runtime(format), value);
  std::string exponent;
  if (const std::size_t e = text.find('e'); e != std::string::npos) {
    exponent = std::to_string(std::stoi(text.substr(e + 1)));
    text.resize(e);
  }
  const auto with_minus = [](std::string digits) {
    if (digits.starts_with('-')) digits.replace(0, 1, "−");
    return digits;
  };
  text = with_minus(std::move(text));
  if (!exponent.empty()) text += " · 10<sup>" + with_minus(std::move(exponent)) + "</sup>";
  return text;
}

std::string to_html(const Table& table) {
  std::string html = "<figure class=\"table\"><figcaption>" + escape_markup(table.title) +
                     fmt::format(
                         " <span class=\"files\"><a class=\"file\" href=\"data/{0}.csv\">CSV</a> <a class=\"file\" "
                         "href=\"data/{0}.json\">JSON</a></span></figcaption>\n",
                         table.name) +
                     "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    const bool is_text = !table.rows.empty() && std::holds_alternative<std::string>(table.rows.front()[j]);
    html += (is_text ? "<th>" : "<th class=\"number\">") + escape_markup(table.columns[j].name) + "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Value>& row : table.rows) {
    html += "<tr>";
    for (std::size_t j = 0; j < row.size(); ++j) html += html_cell(row[j], table.columns[j]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div></figure>\n";
}

std::string to_csv(const Table& table) {
  std::string csv;
  const auto add_line = [&csv](const auto& fields, const auto& text_of) {
    for (std::size_t j = 0; j < fields.size(); ++j) csv += (j == 0 ? "" : ",") + text_of(fields[j]);
    csv += '\n';
  };
  add_line(table.columns, [](const Column& column) { return csv_field(column.name); });
  for (const std::vector<Value>& row : table.rows) add_line(row, csv_field);
  return csv;
}

nlohmann::ordered_json to_json(const Table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::vector<Value>& row : table.rows) {
    nlohmann::ordered_json entry;
    for (std::size_t j = 0; j < row.size(); ++j) entry[table.columns[j].name] = json_value(row[j]);
    rows.push_back(std::move(entry));
  }
  return {{"title", table.title}, {"rows", std::move(rows)}};
}

}  // namespace taut::paper
