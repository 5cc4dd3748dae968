// Lines of numbers. What the columns mean is told by a header, which may stand in a comment (`# x y z`, `//X Y Z R G
// B`), or by the user, who says the dimension. Without either:
//   spatial  (.xyz .pts .asc .txt) x y z | x y z s | x y z nx ny nz | x y z r g b | more, with normals where three
//   columns
//            are unit vectors; after an optional line with the count
//   .pwn     count, then points, then normals, three numbers a line; or as above
//   any      (.csv .tsv) two or three columns are coordinates, more are refused: they may be anything
// Whatever is not x y z alone is told in a note.

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "io/column_roles.hpp"
#include "io/readers.hpp"
#include "io/row_parser.hpp"
#include "io/text_reader.hpp"
#include "taut/io/read_point_cloud.hpp"

namespace taut::detail {
namespace {

constexpr std::size_t kSpace = 3;

/// A table of numbers, row by row.
struct Table {
  std::vector<double> values;
  std::size_t width = 0;  // numbers a row
  std::size_t first_line = 0;
  std::optional<std::uint64_t> declared;  // the count line, where there is one
  std::size_t declared_line = 0;

  [[nodiscard]] std::size_t rows() const { return width == 0 ? 0 : values.size() / width; }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values[row * width + column]; }
};

std::optional<std::uint64_t> as_count(std::string_view line) {
  std::uint64_t count = 0;
  const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), count);
  if (error != std::errc{} || stop != line.data() + line.size()) return std::nullopt;
  return count;
}

void refuse_not_finite(const TextReader& reader, const std::vector<double>& values, std::size_t from, std::size_t dim) {
  for (std::size_t i = 0; i < dim; ++i) {
    const double value = values[from + i];
    if (std::isfinite(value)) continue;
    reader.fail(coordinate_name(static_cast<Index>(i)) + " is " + (std::isnan(value) ? "nan" : "infinite") +
                "; remove the point or give it a finite value");
  }
}

/// Reads rows of one width to the end of the file. The current line of `reader` is the first row. At most `dim` leading
/// entries (all of them if 0) must be finite.
void read_rows(const InputFile& file, TextReader& reader, RowParser& parser, std::size_t dim, Table& table) {
  table.first_line = reader.line_number();
  // Room for the rest of the file if its lines are as long as this one; a number takes two bytes at least.
  bool guessed = false;
  do {
    const std::size_t before = table.values.size();
    const std::string problem = parser.parse(reader.rest(), table.values);
    if (!problem.empty()) reader.fail(problem);
    const std::size_t width = table.values.size() - before;
    if (table.width == 0) table.width = width;
    if (width != table.width) {
      reader.fail("has " + counted(width, "column") + " where line " + std::to_string(table.first_line) + " has " +
                  std::to_string(table.width) + "; complete or remove the line");
    }
    refuse_not_finite(reader, table.values, before, dim == 0 ? width : std::min(dim, width));
    if (!guessed) {
      const std::size_t line_length = std::max<std::size_t>(reader.rest().size() + 1, 2 * width);
      table.values.reserve(width * (file.bytes.size() / line_length + 1));
      guessed = true;
    }
  } while (reader.next_line());
  if (parser.decimal_commas()) file.note("decimal commas are read as points");
}

/// Three columns from `first` on are unit vectors (or zero, for unknown normals) in every row.
bool are_unit_vectors(const Table& table, std::size_t first) {
  constexpr double kSlack = 0.02;  // of length 1: files often carry two or three decimals
  bool any = false;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const Eigen::Vector3d n(table.at(r, first), table.at(r, first + 1), table.at(r, first + 2));
    if (n.isZero(0) || !n.allFinite()) continue;
    if (std::abs(n.norm() - 1) > kSlack) return false;
    any = true;
  }
  return any;
}

/// Three columns from `first` on hold whole numbers 0..255, not all of them 0 or 1.
bool are_colours(const Table& table, std::size_t first) {
  bool beyond_one = false;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    for (std::size_t c = first; c < first + 3; ++c) {
      const double v = table.at(r, c);
      if (!(v >= 0 && v <= 255) || v != std::floor(v)) return false;
      beyond_one = beyond_one || v > 1;
    }
  }
  return beyond_one;
}

/// The column where the normals start in a file without a header; 0 if there are none.
std::size_t find_normals(const Table& table) {
  if (table.width == 2 * kSpace) return are_colours(table, kSpace) ? 0 : kSpace;
  for (std::size_t first = kSpace; first + kSpace <= table.width; ++first) {
    if (are_unit_vectors(table, first)) return first;
  }
  return 0;
}

/// The first column counts the rows from 0 or 1.
bool counts_rows(const Table& table) {
  constexpr std::size_t kFewest = 4;  // shorter tables may do so by chance
  const double first = table.at(0, 0);
  if (table.rows() < kFewest || (first != 0 && first != 1)) return false;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    if (table.at(r, 0) != first + static_cast<double>(r)) return false;
  }
  return true;
}

Points columns_of(const Table& table, std::size_t first, std::size_t dim) {
  const Eigen::Map<const Points> all(table.values.data(), static_cast<Index>(table.width),
                                     static_cast<Index>(table.rows()));
  return all.middleRows(static_cast<Index>(first), static_cast<Index>(dim));
}

/// The first row, or the count before it and then the first row, becomes the reader's current line.
void read_count_line(const InputFile& file, TextReader& reader, Table& table) {
  const auto count = as_count(reader.rest());
  if (!count) return;
  table.declared = count;
  table.declared_line = reader.line_number();
  constexpr std::uint64_t kLeastRow = 6;  // "0 0 0\n"
  check_declared(file, *count, kLeastRow, reader.remaining() + 1,
                 "line " + std::to_string(reader.line_number()) + ": the point count");
  if (!reader.next_line()) file.fail("holds no points after its count; check how it was written");
}

void check_count(const InputFile& file, const Table& table, std::size_t rows) {
  if (!table.declared || *table.declared == rows) return;
  file.fail_at_line(table.declared_line, "announces " + counted(*table.declared, "point") + ", but " +
                                             counted(rows, "line") + (rows == 1 ? " follows" : " follow") +
                                             "; the file is cut short or the count is wrong");
}

/// `.pwn` in its classical form: the points' lines, then the normals' lines.
PointCloud split_halves(const InputFile& file, const Table& table) {
  if (!table.declared) {
    file.fail("has neither six columns nor a count in its first line; write the count, the points, then the normals");
  }
  if (table.rows() != 2 * *table.declared) {
    file.fail_at_line(table.declared_line, "announces " + counted(*table.declared, "point") +
                                               " and as many normals, but " + counted(table.rows(), "line") +
                                               " follow; the file is cut short or the count is wrong");
  }
  const Points all = columns_of(table, 0, 3);
  const Index n = all.cols() / 2;
  return {.points = all.leftCols(n), .normals = all.rightCols(n), .faces = {}};
}

/// Digits after a comma that are no number of their own, as in 1,05: commas that separate have made fields of decimals.
bool looks_like_decimal_commas(const std::vector<std::string_view>& fields) {
  bool leading_zero = false;
  for (const std::string_view field : fields) {
    if (field.find_first_not_of("+-0123456789") != field.npos) return false;
    leading_zero = leading_zero || (field.size() > 1 && field[0] == '0');
  }
  return leading_zero && fields.size() % 2 == 0;
}

constexpr const char* kNoDecimalCommas =
    "if the commas are decimal ones, write points, or put semicolons between the columns";

/// The names of the columns: the reader's current line, or a comment before it that names as many as the line has
/// numbers. Empty if there are none.
std::vector<std::string_view> find_header(TextReader& reader, std::string_view comment, RowParser& parser) {
  parser.choose_separator(reader.rest());
  std::vector<std::string_view> fields = parser.split(reader.rest());
  if (is_header(fields)) return fields;
  RowParser of_comment;
  of_comment.choose_separator(comment);
  std::vector<std::string_view> names = of_comment.split(comment);
  const bool fits = names.size() == fields.size() && is_header(names) && !roles_from_header(names).coordinates.empty();
  return fits ? names : std::vector<std::string_view>();
}

/// Which columns the header and the user make coordinates. The current line of `reader` is the header or the first row.
ColumnRoles roles_of(const InputFile& file, const TextReader& reader, const std::vector<std::string_view>& names,
                     const ColumnOptions& options) {
  ColumnRoles roles = roles_from_header(names);
  std::string header;
  for (const std::string_view name : names) header += (header.empty() ? "" : ",") + std::string(name);
  header = "the header " + quote(header);
  if (roles.angles) {
    reader.fail(header +
                " names latitude and longitude, which are angles; convert them to x,y,z in one unit of length");
  }
  if (roles.some_named && roles.coordinates.empty()) {
    reader.fail(header + " does not name the coordinates; call them x,y,z or x1,...,xd, each once");
  }
  if (!roles.some_named) {
    const std::size_t dim = options.dim ? static_cast<std::size_t>(*options.dim) : names.size();
    if ((!options.dim && names.size() > kSpace) || dim < 2 || dim > names.size()) {
      reader.fail(header + " does not name the coordinates; call them x,y,z or x1,...,xd");
    }
    for (std::size_t i = 0; i < dim; ++i) roles.coordinates.push_back(i);
    roles.others.erase(roles.others.begin(), roles.others.begin() + static_cast<std::ptrdiff_t>(dim));
  }
  if (options.dim && static_cast<Index>(roles.coordinates.size()) != *options.dim) {
    reader.fail(header + " names " + counted(roles.coordinates.size(), "coordinate") + " where " +
                std::to_string(*options.dim) + " are needed");
  }
  const std::string first = lower(names[roles.coordinates[0]]);
  const bool numbered = first.size() > 1 && first[1] >= '0' && first[1] <= '9';
  const bool plain = roles.some_named && first[0] == 'x' && (numbered || roles.coordinates.size() <= kSpace);
  std::string note;
  if (!plain) note = list_columns(names, roles.coordinates) + " are taken as the coordinates";
  if (!roles.others.empty()) {
    note += (note.empty() ? "" : "; ") + list_columns(names, roles.others) +
            (roles.others.size() == 1 ? " is not used" : " are not used");
  }
  if (!note.empty()) file.note(note);
  return roles;
}

/// A table whose columns have names. The current line of `reader` is the first row, or the header itself.
PointCloud read_named(const InputFile& file, TextReader& reader, RowParser& parser,
                      const std::vector<std::string_view>& names, const ColumnOptions& options, Table& table) {
  const ColumnRoles roles = roles_of(file, reader, names, options);
  const std::size_t dim = roles.coordinates.size();
  std::vector<std::size_t> selected = roles.coordinates;
  selected.insert(selected.end(), roles.normals.begin(), roles.normals.end());
  const std::size_t header_line = reader.line_number();
  if (is_header(parser.split(reader.rest()))) {
    if (!reader.next_line()) file.fail_at_line(header_line, "no points follow the header; check how it was written");
    if (!table.declared) read_count_line(file, reader, table);
    parser.choose_separator(reader.rest());
  }
  const std::size_t first_width = parser.split(reader.rest()).size();
  if (first_width != names.size()) {
    reader.fail("has " + counted(first_width, "column") + " where the header has " + std::to_string(names.size()) +
                (parser.separator() == ',' && first_width == 2 * names.size() ? std::string("; ") + kNoDecimalCommas
                                                                              : "; correct the header or the line"));
  }
  const bool reads_all = selected.size() == names.size() && std::is_sorted(selected.begin(), selected.end());
  if (!reads_all) parser.select(std::move(selected));
  read_rows(file, reader, parser, dim, table);
  check_count(file, table, table.rows());
  PointCloud cloud;
  cloud.points = columns_of(table, 0, dim);
  if (!roles.normals.empty()) cloud.normals = columns_of(table, dim, dim);
  return cloud;
}

/// "column 4", "columns 4 to 6"
std::string column_range(std::size_t first, std::size_t count) {
  const std::string from = std::to_string(first + 1);
  return count == 1 ? "column " + from : "columns " + from + " to " + std::to_string(first + count);
}

/// Cuts the table into `dim` coordinates, normals from column `normals` on (0: none) and columns left aside, and says
/// so.
PointCloud cut(const InputFile& file, const Table& table, std::size_t dim, std::size_t normals, bool dim_is_asked) {
  PointCloud cloud;
  cloud.points = columns_of(table, 0, dim);
  if (normals > 0) cloud.normals = columns_of(table, normals, dim);
  if (table.width == dim && (dim == kSpace || dim_is_asked)) return cloud;
  std::string note = column_range(0, dim) + " are taken as coordinates";
  if (normals > 0) note += ", " + column_range(normals, dim) + " as normals";
  std::string unused;
  const auto leave = [&](std::size_t first, std::size_t end) {
    if (first < end) unused += (unused.empty() ? "" : ", ") + column_range(first, end - first);
  };
  leave(dim, normals > 0 ? normals : table.width);
  if (normals > 0) leave(normals + dim, table.width);
  file.note(unused.empty() ? note : note + "; not used: " + unused);
  return cloud;
}

/// A table without names.
PointCloud read_unnamed(const InputFile& file, TextReader& reader, RowParser& parser, ColumnFormat format,
                        const ColumnOptions& options, Table& table) {
  const std::vector<std::string_view> first_fields = parser.split(reader.rest());
  const bool suspicious = parser.separator() == ',' && looks_like_decimal_commas(first_fields);
  const std::size_t width = first_fields.size();
  const std::size_t first_line = reader.line_number();
  if (format == ColumnFormat::any && !options.dim && width > kSpace) {
    // Before the rows are read: what stands in them may be no numbers.
    std::vector<double> ignored;
    const std::string problem = parser.parse(reader.rest(), ignored);
    if (!problem.empty()) reader.fail(problem);
    const std::string what = "line " + std::to_string(first_line) + ": has " + counted(width, "column") +
                             " and no header, so what they mean is not known; ";
    if (suspicious) file.fail(what + kNoDecimalCommas);
    throw UnnamedColumns(file.path, what + "put a header such as x,y,z,intensity in the first line");
  }
  const bool spatial = format != ColumnFormat::any && options.dim.value_or(3) == 3;
  const std::size_t asked = options.dim ? static_cast<std::size_t>(*options.dim) : spatial ? kSpace : width;
  read_rows(file, reader, parser, std::min(asked, width), table);
  if (table.width < 2) {
    file.fail_at_line(first_line, "has one column; a point needs at least two coordinates, one a column");
  }
  if (table.width < asked || (options.whole_lines && table.width != asked)) {
    file.fail_at_line(first_line, "has " + counted(table.width, "column") +
                                      (options.dim ? " where " + std::to_string(asked) + " coordinates are needed"
                                                   : "; x y z are needed (points of other dimensions are read from "
                                                     ".csv or .npy, or with their dimension given)"));
  }
  if (format == ColumnFormat::pwn && table.width == kSpace) return split_halves(file, table);
  check_count(file, table, table.rows());
  if (suspicious && table.width > asked)
    file.fail_at_line(first_line, std::string("has fields such as '05'; ") + kNoDecimalCommas);
  if (!options.dim && table.width > kSpace && counts_rows(table)) {
    file.fail_at_line(first_line, std::string("column 1 counts the lines, as an index does; remove it, or ") +
                                      "name the columns in a header such as id,x,y,z");
  }
  if (spatial) return cut(file, table, kSpace, find_normals(table), options.dim.has_value());
  const bool normals = table.width >= 2 * asked && asked == kSpace && are_unit_vectors(table, asked);
  return cut(file, table, asked, normals ? asked : 0, options.dim.has_value());
}

/// Comments beside those with # that the reader skips.
bool is_comment(std::string_view line) { return line.starts_with("//") || line.starts_with("%"); }

/// The comment lines before the table: the last one that names coordinates, or else the last.
class Comments {
 public:
  void take(std::string_view comment) {
    comment.remove_prefix(std::min(comment.find_first_not_of("#/% \t"), comment.size()));
    RowParser parser;
    parser.choose_separator(comment);
    const bool names = !roles_from_header(parser.split(comment)).coordinates.empty();
    if (names || !names_) kept_ = comment;
    names_ = names_ || names;
  }
  /// Those in `text` that begin with #.
  void take_all(std::string_view text) {
    for (std::size_t at = text.find('#'); at < text.size(); at = text.find('#', at)) {
      const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
      take(text.substr(at, end - at));
      at = end;
    }
  }
  [[nodiscard]] std::string_view kept() const { return kept_; }

 private:
  std::string_view kept_;
  bool names_ = false;
};

/// Goes to the next line that is no comment. `begin`: where the text that was not looked at yet begins.
void skip_comments(const InputFile& file, TextReader& reader, const char* begin, Comments& comments) {
  do {
    if (!reader.next_line()) file.fail("holds no points; check how it was written");
    const std::string_view line = reader.rest();
    comments.take_all({begin, static_cast<std::size_t>(line.data() - begin)});
    begin = line.data() + line.size();
    if (is_comment(line)) comments.take(line);
  } while (is_comment(reader.rest()));
}

/// Does a line of several columns follow the current one?
bool table_follows(TextReader reader) {
  RowParser parser;
  if (!reader.next_line()) return false;
  parser.choose_separator(reader.rest());
  return parser.split(reader.rest()).size() > 1;
}

}  // namespace

PointCloud read_columns(const InputFile& file, ColumnFormat format, const ColumnOptions& options) {
  TextReader reader(file, '#');
  Comments comments;
  skip_comments(file, reader, file.bytes.data(), comments);
  Table table;
  // A lone number heads a .csv only if it cannot be a first point of its own.
  if (format != ColumnFormat::any || table_follows(reader)) read_count_line(file, reader, table);
  if (is_comment(reader.rest())) {  // behind the count
    comments.take(reader.rest());
    skip_comments(file, reader, reader.rest().data() + reader.rest().size(), comments);
  }
  RowParser parser;
  const std::vector<std::string_view> names = find_header(reader, comments.kept(), parser);
  return names.empty() ? read_unnamed(file, reader, parser, format, options, table)
                       : read_named(file, reader, parser, names, options, table);
}

}  // namespace taut::detail
