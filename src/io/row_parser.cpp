#include "io/row_parser.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "io/input_file.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return trimmed(text.substr(1, text.size() - 2));
  return text;
}

NumberProblem read_field(std::string_view field, double& value) {
  const char* p = field.data();
  const char* end = p + field.size();
  const NumberProblem problem = parse_number(p, end, value);
  return problem == NumberProblem::none && p != end ? NumberProblem::not_a_number : problem;
}

/// A number with one comma between digits, or before them, and no point.
bool has_decimal_comma(std::string_view field) {
  const std::size_t comma = field.find(',');
  return comma != field.npos && field.find_first_of(",.", comma + 1) == field.npos &&
         field.substr(0, comma).find('.') == field.npos && comma + 1 < field.size() && field[comma + 1] >= '0' &&
         field[comma + 1] <= '9';
}

NumberProblem read_decimal_comma(std::string_view field, double& value) {
  std::string with_point(field);
  with_point[field.find(',')] = '.';
  return read_field(with_point, value);
}

}  // namespace

bool is_sample(std::string_view field) {
  return field.size() > 1 && field[0] == '@' && field[1] >= '0' && field[1] <= '9';
}

bool is_number(std::string_view field) {
  double value = 0;
  return read_field(field, value) != NumberProblem::not_a_number;
}

void RowParser::choose_separator(std::string_view first_line) {
  const auto has = [&](char c) { return first_line.find(c) != first_line.npos; };
  if (has(';')) {
    separator_ = ';';
    return;
  }
  separator_ = has(',') ? ',' : ' ';
  if (!has('\t')) return;
  // Commas beside tabs are decimal ones if that makes numbers of all fields; blanks beside tabs belong to names.
  const char otherwise = std::exchange(separator_, '\t');
  const std::vector<std::string_view> fields = split(first_line);
  const bool decimals = std::ranges::all_of(fields, [](std::string_view field) {
    double value = 0;
    return is_number(field) || (has_decimal_comma(field) && read_decimal_comma(field, value) == NumberProblem::none);
  });
  const bool names = std::ranges::any_of(fields, [](std::string_view field) { return field.find(' ') != field.npos; });
  if (otherwise == ',' ? !decimals : !names) separator_ = otherwise;
}

void RowParser::select(std::vector<std::size_t> columns) { columns_ = std::move(columns); }

void RowParser::set_samples(const Points* samples) { samples_ = samples; }

std::string RowParser::append_sample(std::string_view field, std::vector<double>& values) const {
  if (samples_ == nullptr) return quote(field) + " names a sample, and here there are none; give coordinates";
  Index index = 0;
  const char* last = field.data() + field.size();
  const auto [end, error] = std::from_chars(field.data() + 1, last, index);
  if (error == std::errc::invalid_argument || end != last) return quote(field) + " is no sample; write as in @17";
  if (error != std::errc() || index >= samples_->cols()) {
    return quote(field) + ": samples go from @0 to @" + std::to_string(samples_->cols() - 1);
  }
  const auto point = samples_->col(index);
  values.insert(values.end(), point.begin(), point.end());
  return {};
}

std::string RowParser::parse(std::string_view line, std::vector<double>& values) {
  if (!columns_.empty() || separator_ == '\t') return parse_fields(line, values);
  const char* p = line.data();
  const char* end = p + line.size();
  const std::size_t before = values.size();
  const auto skip_blanks = [&] {
    while (p != end && is_blank(*p)) ++p;
  };
  while (true) {
    skip_blanks();
    if (p == end) break;  // also after a separator at the end of the line
    const char* start = p;
    double value = 0;
    bool ends_well = parse_number(p, end, value) == NumberProblem::none;
    const char* stop = p;
    skip_blanks();
    ends_well = ends_well && start != stop && (p == end || (separator_ == ' ' ? p != stop : *p == separator_));
    if (!ends_well) {
      // A quote, a decimal comma or a mistake: field by field.
      values.resize(before);
      return parse_fields(line, values);
    }
    if (separator_ != ' ' && p != end) ++p;
    values.push_back(value);
  }
  seen_point_ = seen_point_ || (separator_ == ';' && line.find('.') != line.npos);
  return {};
}

std::string RowParser::parse_fields(std::string_view line, std::vector<double>& values) {
  const std::vector<std::string_view> fields = split(line);
  const std::size_t count = columns_.empty() ? fields.size() : columns_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = columns_.empty() ? i : columns_[i];
    if (column >= fields.size()) return explain(line, column);
    const std::string_view field = fields[column];
    if (is_sample(field)) {
      if (std::string problem = append_sample(field, values); !problem.empty()) return problem;
      continue;
    }
    double value = 0;
    // Where commas separate, a field holds one only if it stood in quotes.
    const bool comma = separator_ != ' ' && has_decimal_comma(field);
    if ((comma ? read_decimal_comma(field, value) : read_field(field, value)) != NumberProblem::none) {
      return explain(line, column);
    }
    seen_comma_ = seen_comma_ || comma;
    seen_point_ = seen_point_ || field.find('.') != field.npos;
    values.push_back(value);
  }
  if (seen_comma_ && seen_point_) {
    return "decimal commas and decimal points are mixed; write all decimals in one way, and no thousands separators";
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

}  // namespace taut::detail
