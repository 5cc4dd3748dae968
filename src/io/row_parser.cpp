#include "io/row_parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

#include "io/input_file.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

NumberProblem read_field(std::string_view field, double& value) {
  const char* p = field.data();
  const char* end = p + field.size();
  const NumberProblem problem = parse_number(p, end, value);
  return problem == NumberProblem::none && p != end ? NumberProblem::not_a_number : problem;
}

/// The place of a name such as "y" or "x12" among the coordinates, from 0; -1 if it is none.
int coordinate_place(std::string_view name) {
  constexpr std::array<std::string_view, 4> kLetters = {"x", "y", "z", "w"};
  const auto* letter = std::find(kLetters.begin(), kLetters.end(), name);
  if (letter != kLetters.end()) return static_cast<int>(letter - kLetters.begin());
  int place = 0;
  if (name.size() < 2 || name.front() != 'x') return -1;
  const auto [stop, error] = std::from_chars(name.data() + 1, name.data() + name.size(), place);
  return error == std::errc{} && stop == name.data() + name.size() && place >= 1 ? place - 1 : -1;
}

/// The same for a normal's entry: "ny", "normal_y", "n12".
int normal_place(std::string_view name) {
  for (const std::string_view prefix : {"normal_", "normal", "n"}) {
    if (!name.starts_with(prefix)) continue;
    const std::string_view rest = name.substr(prefix.size());
    if (!rest.empty() && rest.front() >= '1' && rest.front() <= '9') {
      std::string numbered = "x";
      numbered += rest;
      return coordinate_place(numbered);
    }
    return coordinate_place(rest);
  }
  return -1;
}

/// Columns sorted by place; empty unless the places are 0, 1, ..., n-1, each once.
std::vector<std::size_t> in_order(std::vector<std::pair<int, std::size_t>> places) {
  std::sort(places.begin(), places.end());
  std::vector<std::size_t> columns;
  for (const auto& [place, column] : places) {
    if (place != static_cast<int>(columns.size())) return {};
    columns.push_back(column);
  }
  return columns;
}

}  // namespace

void RowParser::choose_separator(std::string_view first_line) {
  separator_ = first_line.find(';') != std::string_view::npos   ? ';'
               : first_line.find(',') != std::string_view::npos ? ','
                                                                : ' ';
}

void RowParser::select(std::vector<std::size_t> columns) { columns_ = std::move(columns); }

std::string RowParser::parse(std::string_view line, std::vector<double>& values) const {
  if (!columns_.empty()) return parse_selected(line, values);
  const char* p = line.data();
  const char* end = p + line.size();
  const auto skip_blanks = [&] {
    while (p != end && is_blank(*p)) ++p;
  };
  for (std::size_t column = 0;; ++column) {
    skip_blanks();
    if (p == end) return {};  // also after a separator at the end of the line
    const char* start = p;
    double value = 0;
    if (parse_number(p, end, value) != NumberProblem::none) return explain(line, column);
    const char* stop = p;
    skip_blanks();
    const bool ends_well = p == end || (separator_ == ' ' ? p != stop : *p == separator_);
    if (!ends_well || start == stop) return explain(line, column);
    if (separator_ != ' ' && p != end) ++p;
    values.push_back(value);
  }
}

std::string RowParser::parse_selected(std::string_view line, std::vector<double>& values) const {
  const std::vector<std::string_view> fields = split(line);
  for (const std::size_t column : columns_) {
    double value = 0;
    if (column >= fields.size() || read_field(fields[column], value) != NumberProblem::none) {
      return explain(line, column);
    }
    values.push_back(value);
  }
  return {};
}

std::vector<std::string_view> RowParser::split(std::string_view line) const {
  std::vector<std::string_view> fields;
  std::size_t start = 0;
  bool in_quotes = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') in_quotes = !in_quotes;
    const bool cut =
        i == line.size() || (!in_quotes && (separator_ == ' ' ? is_blank(line[i]) : line[i] == separator_));
    if (!cut) continue;
    const std::string_view field = trimmed(line.substr(start, i - start));
    start = i + 1;
    const bool counts = separator_ == ' ' ? !field.empty() : i < line.size() || !field.empty();
    if (counts) fields.push_back(field);
  }
  return fields;
}

std::string RowParser::explain(std::string_view line, std::size_t column) const {
  const std::vector<std::string_view> fields = split(line);
  std::string where = "column " + std::to_string(column + 1);
  if (column >= fields.size()) return where + " is missing; complete the line";
  const std::string_view field = fields[column];
  if (field.empty()) return where + " is empty; fill it in or remove the line";
  double value = 0;
  where += ": " + quote(field);
  const NumberProblem problem = read_field(field, value);
  if (problem == NumberProblem::too_large) return where + " is too large for a double; rescale the data";
  if (field.find_first_of(", \t") != std::string_view::npos) {
    return where +
           " is not one number; separate columns by commas or by blanks, not both, and write decimals with a point";
  }
  return where + " is not a number; correct the line";
}

bool is_header(const std::vector<std::string_view>& fields) {
  const auto begins_like_a_number = [](std::string_view field) {
    const auto first = field.find_first_not_of("+-.");
    return first != std::string_view::npos && field[first] >= '0' && field[first] <= '9';
  };
  const auto is_number = [](std::string_view field) {
    double value = 0;
    return read_field(field, value) != NumberProblem::not_a_number;
  };
  return !std::all_of(fields.begin(), fields.end(), is_number) &&
         std::none_of(fields.begin(), fields.end(), begins_like_a_number);
}

ColumnRoles roles_from_header(const std::vector<std::string_view>& names) {
  ColumnRoles roles;
  std::vector<std::pair<int, std::size_t>> coordinates;
  std::vector<std::pair<int, std::size_t>> normals;
  for (std::size_t column = 0; column < names.size(); ++column) {
    const std::string name = lower(names[column]);
    if (const int place = coordinate_place(name); place >= 0) {
      coordinates.emplace_back(place, column);
    } else if (const int normal = normal_place(name); normal >= 0) {
      normals.emplace_back(normal, column);
    } else {
      roles.others.push_back(column);
    }
  }
  if (coordinates.empty() && normals.empty()) {
    roles.coordinates.resize(names.size());
    std::iota(roles.coordinates.begin(), roles.coordinates.end(), std::size_t{0});
    roles.others.clear();
    return roles;
  }
  roles.named = true;
  roles.coordinates = in_order(std::move(coordinates));
  roles.normals = in_order(std::move(normals));
  if (roles.normals.size() != roles.coordinates.size()) roles.normals.clear();
  return roles;
}

}  // namespace taut::detail
