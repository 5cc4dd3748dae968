// PLY (Turk 1994): a text header that declares elements and their properties, then rows, as text or binary.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <unordered_set>

#include "io/readers.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::array<std::uint64_t, 8> kScalarSizes = {1, 1, 2, 2, 4, 4, 4, 8};

std::uint64_t size_of(ScalarType type) { return kScalarSizes[static_cast<std::size_t>(type)]; }

struct Property {
  std::string name;
  ScalarType type = ScalarType::float32;
  bool is_list = false;
  ScalarType count_type = ScalarType::uint8;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  std::size_t line = 0;  // of its declaration
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t data_offset = 0;
  std::size_t data_line = 0;
};

// --- The header ------------------------------------------------------------------------------------------------------

/// The header's lines, one after the other. It is text even in a binary file, so it is cut here and not by TextReader.
class HeaderLines {
 public:
  explicit HeaderLines(const InputFile& file) : file_(file) {}

  std::string_view next() {
    const std::string_view bytes = file_.bytes;
    const auto feed = bytes.find_first_of("\r\n", offset_);
    constexpr std::size_t kLongest = 1 << 16;
    if (feed == std::string_view::npos || feed - offset_ > kLongest) {
      file_.fail_at_line(line_ + 1, "the header has no 'end_header'; the file is cut short or is no PLY file");
    }
    std::string_view line = bytes.substr(offset_, feed - offset_);
    offset_ = feed + 1;
    if (bytes[feed] == '\r' && offset_ < bytes.size() && bytes[offset_] == '\n') ++offset_;
    ++line_;
    return line;
  }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& problem) const { file_.fail_at_line(line_, problem); }

 private:
  const InputFile& file_;
  std::size_t offset_ = 0;
  std::size_t line_ = 0;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (true) {
    while (i < line.size() && is_blank(line[i])) ++i;
    if (i == line.size()) return words;
    const std::size_t start = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    words.push_back(line.substr(start, i - start));
  }
}

ScalarType parse_type(const HeaderLines& lines, std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                      {"uchar", "uint8"},
                                                                      {"short", "int16"},
                                                                      {"ushort", "uint16"},
                                                                      {"int", "int32"},
                                                                      {"uint", "uint32"},
                                                                      {"float", "float32"},
                                                                      {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<ScalarType>(i);
  }
  lines.fail("unknown type " + quote(name) + "; PLY knows char uchar short ushort int uint float double");
}

Encoding parse_encoding(const HeaderLines& lines, const std::vector<std::string_view>& words) {
  if (words.size() == 3 && words[1] == "ascii") return Encoding::ascii;
  if (words.size() == 3 && words[1] == "binary_little_endian") return Encoding::little_endian;
  if (words.size() == 3 && words[1] == "binary_big_endian") return Encoding::big_endian;
  lines.fail(
      "unknown format; write 'format ascii 1.0', 'format binary_little_endian 1.0' or 'format binary_big_endian 1.0'");
}

Element parse_element(const HeaderLines& lines, const std::vector<std::string_view>& words) {
  if (words.size() != 3) lines.fail("an element needs a name and a count; write 'element vertex 100'");
  Element element{std::string(words[1]), 0, {}, lines.line()};
  const char* end = words[2].data() + words[2].size();
  const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
  if (error != std::errc{} || stop != end) {
    lines.fail("the count of element " + quote(words[1]) + ", " + quote(words[2]) +
               ", is not a whole number; correct it");
  }
  return element;
}

void parse_property(const HeaderLines& lines, const std::vector<std::string_view>& words, Header& header) {
  if (header.elements.empty()) lines.fail("a property stands before the first element; the header is damaged");
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (!is_list && words.size() != 3) {
    lines.fail("cannot read this property; write 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  }
  Property property;
  property.name = words.back();
  property.is_list = is_list;
  property.type = parse_type(lines, words[is_list ? 3 : 1]);
  if (is_list) property.count_type = parse_type(lines, words[2]);
  Element& element = header.elements.back();
  const bool repeated = std::any_of(element.properties.begin(), element.properties.end(),
                                    [&](const Property& p) { return p.name == property.name; });
  if (repeated) lines.fail("property " + quote(property.name) + " is declared twice; remove one");
  element.properties.push_back(std::move(property));
}

Header parse_header(const InputFile& file) {
  HeaderLines lines(file);
  Header header;
  bool has_format = false;
  if (!file.bytes.starts_with("ply")) file.fail_at_byte(0, "does not start with 'ply'; it is no PLY file");
  if (words_of(lines.next()) != std::vector<std::string_view>{"ply"}) {
    lines.fail("the first line is not 'ply'; it is no PLY file");
  }
  while (true) {
    const std::string_view line = lines.next();
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      header.encoding = parse_encoding(lines, words);
      has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(lines, words));
    } else if (words[0] == "property") {
      parse_property(lines, words, header);
    } else {
      lines.fail("unknown keyword " + quote(words[0]) + " in the header; the header is damaged");
    }
  }
  if (!has_format) file.fail("the header has no 'format' line; add one, for instance 'format ascii 1.0'");
  header.data_offset = lines.offset();
  header.data_line = lines.line() + 1;
  return header;
}

// --- The rows --------------------------------------------------------------------------------------------------------

/// Rows as text: one a line.
class AsciiRows {
 public:
  AsciiRows(const InputFile& file, const Header& header)
      : file_(file), reader_(file, 0, header.data_offset, header.data_line) {}

  /// The least a row of this element takes: a digit and a separator for each number.
  [[nodiscard]] static std::uint64_t least_size(const Element& element) { return 2 * element.properties.size(); }
  [[nodiscard]] std::size_t remaining() const { return reader_.remaining() + 1; }  // the last line end may be missing
  /// Bytes from where we are within the row, or more.
  [[nodiscard]] std::size_t remaining_here() { return reader_.rest().size() + remaining(); }

  void begin_row(const Element& element, std::uint64_t row) {
    if (reader_.next_line()) return;
    file_.fail("the file ends after " + std::to_string(row) + " of " + std::to_string(element.count) +
               " rows of element " + quote(element.name) + "; it is cut short or its header is wrong");
  }
  void end_row(const Element& element) {
    if (!reader_.line_is_done()) {
      reader_.fail("more numbers than element " + quote(element.name) + " has properties; the header is wrong");
    }
  }
  double value(const Property& property, ScalarType) { return reader_.number(property.name); }
  /// Leaves the rest of the row unread.
  void skip_row(const Element&) {}
  void check_end() {
    if (reader_.next_line()) reader_.fail("more rows than the header declares; correct its counts");
  }
  [[noreturn]] void fail(const std::string& problem) const { reader_.fail(problem); }

 private:
  const InputFile& file_;
  TextReader reader_;
};

/// Rows as bytes, one after the other.
class BinaryRows {
 public:
  BinaryRows(const InputFile& file, const Header& header)
      : file_(file),
        p_(file.bytes.data() + header.data_offset),
        end_(file.bytes.data() + file.bytes.size()),
        swaps_((header.encoding == Encoding::big_endian) != (std::endian::native == std::endian::big)) {}

  [[nodiscard]] static std::uint64_t least_size(const Element& element) {
    std::uint64_t size = 0;
    for (const Property& p : element.properties) size += size_of(p.is_list ? p.count_type : p.type);
    return size;
  }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - p_); }
  [[nodiscard]] std::size_t remaining_here() const { return remaining(); }

  void begin_row(const Element& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    row_start_ = p_;
  }
  void end_row(const Element&) {}
  double value(const Property&, ScalarType type) {
    if (remaining() < size_of(type)) fail_short();
    switch (type) {
      case ScalarType::int8: return take<std::int8_t>();
      case ScalarType::uint8: return take<std::uint8_t>();
      case ScalarType::int16: return take<std::int16_t>();
      case ScalarType::uint16: return take<std::uint16_t>();
      case ScalarType::int32: return take<std::int32_t>();
      case ScalarType::uint32: return take<std::uint32_t>();
      case ScalarType::float32: return take<float>();
      case ScalarType::float64: return take<double>();
    }
    return 0;
  }
  void skip_row(const Element& element) {
    for (const Property& property : element.properties) {
      std::uint64_t count = 1;
      if (property.is_list) {
        const double n = value(property, property.count_type);
        if (!(n >= 0) || n != std::floor(n)) {
          fail("list " + quote(property.name) + " has an impossible length; the file is damaged");
        }
        if (n > static_cast<double>(remaining())) fail_short();
        count = static_cast<std::uint64_t>(n);
      }
      if (count > remaining() / size_of(property.type)) fail_short();
      p_ += count * size_of(property.type);
    }
  }
  void check_end() const {
    const bool only_blanks = std::all_of(p_, end_, [](char c) { return c == '\n' || c == '\0' || is_blank(c); });
    if (!only_blanks) {
      file_.fail_at_byte(offset(p_), counted(remaining(), "byte") +
                                         " left after the last row; the header's counts or types are wrong");
    }
  }
  [[noreturn]] void fail(const std::string& problem) const {
    file_.fail_at_byte(offset(row_start_), element_->name + " " + std::to_string(row_) + " (from 0): " + problem);
  }

 private:
  template <class T>
  double take() {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), p_, sizeof(T));
    p_ += sizeof(T);
    if (swaps_) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<T>(raw));
  }
  [[nodiscard]] std::size_t offset(const char* p) const { return static_cast<std::size_t>(p - file_.bytes.data()); }
  [[noreturn]] void fail_short() const {
    file_.fail("the file ends in row " + std::to_string(row_) + " of " + std::to_string(element_->count) +
               " of element " + quote(element_->name) + "; it is cut short or its header is wrong");
  }

  const InputFile& file_;
  const char* p_;
  const char* end_;
  const char* row_start_ = nullptr;
  const Element* element_ = nullptr;
  std::uint64_t row_ = 0;
  bool swaps_;
};

// --- The elements ----------------------------------------------------------------------------------------------------

/// For each property the row of x y z nx ny nz it fills, or -1.
std::vector<int> vertex_slots(const InputFile& file, const Element& vertex, bool& has_normals) {
  constexpr std::array<std::string_view, 6> kNames = {"x", "y", "z", "nx", "ny", "nz"};
  std::vector<int> slots(vertex.properties.size(), -1);
  std::array<bool, 6> found = {};
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto* name = std::find(kNames.begin(), kNames.end(), lower(vertex.properties[i].name));
    if (name == kNames.end() || vertex.properties[i].is_list) continue;
    slots[i] = static_cast<int>(name - kNames.begin());
    found[static_cast<std::size_t>(slots[i])] = true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (found[i]) continue;
    file.fail_at_line(vertex.line, "element 'vertex' has no property " + quote(kNames[i]) + "; points need x, y and z");
  }
  has_normals = found[3] && found[4] && found[5];
  return slots;
}

template <class Rows>
std::uint64_t read_length(Rows& rows, const Property& property) {
  const double length = rows.value(property, property.count_type);
  if (!(length >= 0) || length != std::floor(length)) {
    rows.fail("list " + quote(property.name) + " has an impossible length; the file is damaged");
  }
  if (length > static_cast<double>(rows.remaining_here())) {
    rows.fail("list " + quote(property.name) + " is longer than the file; the file is damaged");
  }
  return static_cast<std::uint64_t>(length);
}

template <class Rows>
void skip_property(Rows& rows, const Property& property) {
  const std::uint64_t n = property.is_list ? read_length(rows, property) : 1;
  for (std::uint64_t i = 0; i < n; ++i) rows.value(property, property.type);
}

template <class Rows>
void read_indices(Rows& rows, const Property& property, std::vector<std::int64_t>& out) {
  out.clear();
  const std::uint64_t n = read_length(rows, property);
  for (std::uint64_t i = 0; i < n; ++i) {
    const double index = rows.value(property, property.type);
    if (!(std::abs(index) <= static_cast<double>(kMostPoints)) || index != std::floor(index)) {
      rows.fail("list " + quote(property.name) + " holds something that is no index; the file is damaged");
    }
    out.push_back(static_cast<std::int64_t>(index));
  }
}

template <class Rows>
void read_vertices(const InputFile& file, Rows& rows, const Element& vertex, PointCloud& cloud) {
  bool has_normals = false;
  const std::vector<int> slots = vertex_slots(file, vertex, has_normals);
  const auto n = static_cast<Index>(vertex.count);
  cloud.points.resize(3, n);
  if (has_normals) cloud.normals.resize(3, n);
  std::array<double, 6> row = {};
  for (Index j = 0; j < n; ++j) {
    rows.begin_row(vertex, static_cast<std::uint64_t>(j));
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const Property& property = vertex.properties[i];
      if (slots[i] < 0) {
        skip_property(rows, property);
        continue;
      }
      const double value = rows.value(property, property.type);
      row[static_cast<std::size_t>(slots[i])] = value;
      if (slots[i] < 3 && !std::isfinite(value)) {
        rows.fail(coordinate_name(slots[i]) + " is " + (std::isnan(value) ? "nan" : "infinite") +
                  "; remove the point or give it a finite value");
      }
    }
    rows.end_row(vertex);
    cloud.points.col(j) << row[0], row[1], row[2];
    if (has_normals) cloud.normals.col(j) << row[3], row[4], row[5];
  }
}

/// Triangles of a strip in which -1 starts a new one; every other triangle is turned round.
void append_strip(const std::vector<int>& strip, std::vector<int>& corners) {
  std::size_t start = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] < 0) {
      start = i + 1;
    } else if (i >= start + 2) {
      const bool turned = (i - start) % 2 == 1;
      const std::array<int, 3> triangle = {strip[i - 2], strip[turned ? i : i - 1], strip[turned ? i - 1 : i]};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
  }
}

template <class Rows>
void read_faces(Rows& rows, const Element& face, std::uint64_t num_vertices, std::vector<int>& corners) {
  const bool strips = face.name == "tristrips";
  const auto indices = std::find_if(face.properties.begin(), face.properties.end(), [](const Property& p) {
    return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
  });
  std::vector<std::int64_t> list;
  std::vector<int> polygon;
  for (std::uint64_t row = 0; row < face.count; ++row) {
    rows.begin_row(face, row);
    if (indices == face.properties.end()) {
      rows.skip_row(face);
      continue;
    }
    for (const Property& property : face.properties) {
      if (&property != &*indices) {
        skip_property(rows, property);
        continue;
      }
      read_indices(rows, property, list);
      polygon.clear();
      for (const std::int64_t index : list) {
        const bool restarts = strips && index == -1;
        if (!restarts && (index < 0 || static_cast<std::uint64_t>(index) >= num_vertices)) {
          rows.fail("vertex index " + std::to_string(index) + " is out of range (there are " +
                    std::to_string(num_vertices) + " vertices, counted from 0); correct the face");
        }
        polygon.push_back(static_cast<int>(index));
      }
      strips ? append_strip(polygon, corners) : append_fan(polygon, corners);
    }
    rows.end_row(face);
  }
}

std::string names_of(const std::vector<Element>& elements) {
  std::string names;
  for (const Element& element : elements) names += (names.empty() ? "" : ", ") + element.name;
  return names.empty() ? "none at all" : names;
}

const Element& vertex_element(const InputFile& file, const Header& header) {
  const auto vertex =
      std::find_if(header.elements.begin(), header.elements.end(), [](const Element& e) { return e.name == "vertex"; });
  if (vertex == header.elements.end()) {
    file.fail("has no element 'vertex' (its elements: " + names_of(header.elements) +
              "), so it holds no points; a depth frame must be converted to points first");
  }
  std::unordered_set<std::string_view> names;
  for (const Element& element : header.elements) {
    if (!names.insert(element.name).second) {
      file.fail_at_line(element.line, "element " + quote(element.name) + " is declared twice; merge the two");
    }
  }
  if (vertex->count > kMostPoints) {
    file.fail_at_line(vertex->line,
                      "declares " + std::to_string(vertex->count) +
                          " vertices, more than 2^31 - 1; the header is wrong or the cloud must be thinned");
  }
  return *vertex;
}

template <class Rows>
PointCloud read_elements(const InputFile& file, const Header& header) {
  const Element& vertex = vertex_element(file, header);
  Rows rows(file, header);
  PointCloud cloud;
  std::vector<int> corners;
  for (const Element& element : header.elements) {
    if (element.properties.empty() && element.count > 0) {
      file.fail_at_line(element.line, "element " + quote(element.name) + " has no properties; the header is damaged");
    }
    check_declared(file, element.count, Rows::least_size(element), rows.remaining(),
                   "line " + std::to_string(element.line) + ": the count of element " + quote(element.name));
    if (&element == &vertex) {
      read_vertices(file, rows, element, cloud);
    } else if (element.name == "face" || element.name == "tristrips") {
      read_faces(rows, element, vertex.count, corners);
    } else {
      for (std::uint64_t row = 0; row < element.count; ++row) {
        rows.begin_row(element, row);
        rows.skip_row(element);
      }
    }
  }
  rows.check_end();
  cloud.faces = to_faces(corners);
  return cloud;
}

}  // namespace

PointCloud read_ply(const InputFile& file) {
  const Header header = parse_header(file);
  return header.encoding == Encoding::ascii ? read_elements<AsciiRows>(file, header)
                                            : read_elements<BinaryRows>(file, header);
}

}  // namespace taut::detail
