// Lines of numbers. What the columns of a line mean, for files without a header:
//   .xyz  x y z | x y z s | x y z nx ny nz | x y z r g b | more, with normals where three columns are unit vectors
//   .pts  the same, after an optional line with the count; s is an intensity
//   .pwn  count, then points, then normals, three numbers a line; or x y z nx ny nz
//   .csv  one coordinate a column, any number of them; or columns named in a header line

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "io/readers.hpp"
#include "io/row_parser.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

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
void read_rows(const InputFile& file, TextReader& reader, const RowParser& parser, std::size_t dim, Table& table) {
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
  if (table.width == 6) return are_colours(table, 3) ? 0 : 3;
  for (std::size_t first = 3; first + 3 <= table.width; ++first) {
    if (are_unit_vectors(table, first)) return first;
  }
  return 0;
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

/// A table below a line of column names, which is the reader's current line.
PointCloud read_named(const InputFile& file, TextReader& reader, RowParser& parser) {
  const std::vector<std::string_view> names = parser.split(reader.rest());
  const ColumnRoles roles = roles_from_header(names);
  const std::size_t dim = roles.coordinates.size();
  Table table;
  if (dim < 2) {
    reader.fail("the header " + quote(reader.rest()) + " does not name the coordinates; call them x,y,z or x1,...,xd");
  }
  for (const std::size_t column : roles.others) file.note("column " + quote(names[column]) + " is not used");
  std::vector<std::size_t> selected = roles.coordinates;
  selected.insert(selected.end(), roles.normals.begin(), roles.normals.end());
  const std::size_t header_line = reader.line_number();
  const bool reads_all = selected.size() == names.size() && std::is_sorted(selected.begin(), selected.end());
  if (!reads_all) parser.select(std::move(selected));
  if (!reader.next_line()) file.fail_at_line(header_line, "no points follow the header; check how it was written");
  const std::size_t first_width = parser.split(reader.rest()).size();
  if (first_width != names.size()) {
    reader.fail("has " + counted(first_width, "column") + " where the header has " + std::to_string(names.size()) +
                "; correct the header or the line");
  }
  read_rows(file, reader, parser, dim, table);
  PointCloud cloud;
  cloud.points = columns_of(table, 0, dim);
  if (!roles.normals.empty()) cloud.normals = columns_of(table, dim, dim);
  return cloud;
}

/// `.csv`: a header, or numbers only, a coordinate a column.
PointCloud read_csv(const InputFile& file, TextReader& reader) {
  RowParser parser;
  parser.choose_separator(reader.rest());
  if (is_header(parser.split(reader.rest()))) return read_named(file, reader, parser);
  Table table;
  read_rows(file, reader, parser, 0, table);
  if (table.width < 2) {
    file.fail_at_line(table.first_line, "has one column; a point needs at least two coordinates, one a column");
  }
  return {.points = to_points(table.values, static_cast<Index>(table.width)), .normals = {}, .faces = {}};
}

/// `.xyz` and its relatives: a header only where it names x y z.
bool has_header(TextReader& reader, RowParser& parser) {
  parser.choose_separator(reader.rest());
  const std::vector<std::string_view> names = parser.split(reader.rest());
  return is_header(names) && roles_from_header(names).named;
}

}  // namespace

PointCloud read_columns(const InputFile& file, ColumnFormat format) {
  TextReader reader(file, '#');
  if (!reader.next_line()) file.fail("holds no points; check how it was written");
  if (format == ColumnFormat::csv) return read_csv(file, reader);
  Table table;
  read_count_line(file, reader, table);
  RowParser parser;
  if (has_header(reader, parser)) return read_named(file, reader, parser);
  read_rows(file, reader, parser, 3, table);
  if (table.width < 3) {
    file.fail_at_line(table.first_line,
                      "has " + counted(table.width, "column") +
                          "; x y z are needed (points of other dimensions are read from .csv or .npy)");
  }
  if (format == ColumnFormat::pwn && table.width == 3) return split_halves(file, table);
  check_count(file, table, table.rows());
  PointCloud cloud;
  cloud.points = columns_of(table, 0, 3);
  const std::size_t normals = find_normals(table);
  if (normals > 0) cloud.normals = columns_of(table, normals, 3);
  const std::size_t unused = table.width - (normals > 0 ? 6 : 3);
  if (unused > 0) file.note(counted(unused, "column") + " beside coordinates and normals not used");
  return cloud;
}

}  // namespace taut::detail
