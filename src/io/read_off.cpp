// OFF (Geomview): a keyword, the counts of vertices, faces and edges, the vertices, the faces. The keyword's prefixes
// say what follows the coordinates of a vertex: N a normal, C a colour, ST texture coordinates.

#include <algorithm>
#include <string_view>

#include "io/readers.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

/// Reads the keyword; returns whether vertices carry normals.
bool read_keyword(TextReader& reader) {
  const std::string_view word = reader.word();
  if (!word.ends_with("OFF")) {
    reader.fail("starts with " + quote(word) + " instead of OFF; it is no OFF file");
  }
  std::string_view prefix = word.substr(0, word.size() - 3);
  if (prefix.starts_with("ST")) prefix.remove_prefix(2);
  if (prefix.starts_with("C")) prefix.remove_prefix(1);
  const bool has_normals = prefix.starts_with("N");
  if (has_normals) prefix.remove_prefix(1);
  if (!prefix.empty()) {
    reader.fail("the OFF variant " + quote(word) + " is not supported; save it as OFF, COFF, NOFF or STOFF");
  }
  if (!reader.line_is_done() && reader.rest().starts_with("BINARY")) {
    reader.fail("binary OFF is not supported; save it as text OFF or as PLY");
  }
  return has_normals;
}

std::uint64_t read_count(TextReader& reader, std::string_view what) {
  const std::int64_t count = reader.integer(what);
  if (count < 0) reader.fail(std::string(what) + " is negative; correct it");
  return static_cast<std::uint64_t>(count);
}

void next_row(const InputFile& file, TextReader& reader, std::string_view what, std::uint64_t row,
              std::uint64_t count) {
  if (reader.next_line()) return;
  file.fail("the file ends after " + std::to_string(row) + " of " + std::to_string(count) + " " + std::string(what) +
            "; it is cut short or its counts are wrong");
}

}  // namespace

PointCloud read_off(const InputFile& file) {
  TextReader reader(file, '#');
  if (!reader.next_line()) file.fail("holds no data; check how it was written");
  const bool has_normals = read_keyword(reader);
  if (reader.line_is_done() && !reader.next_line()) file.fail("the file ends before its counts; it is cut short");
  const std::uint64_t n = read_count(reader, "the vertex count");
  const std::uint64_t m = read_count(reader, "the face count");
  const std::string where = "line " + std::to_string(reader.line_number()) + ": the vertex count";
  constexpr std::uint64_t kLeastRow = 6;  // "0 0 0\n"
  check_declared(file, n, kLeastRow, reader.remaining() + 1, where);
  check_declared(file, m, 2, reader.remaining() + 1,
                 "line " + std::to_string(reader.line_number()) + ": the face count");
  if (n > kMostPoints) reader.fail("declares more than 2^31 - 1 vertices; thin the mesh");

  PointCloud cloud;
  cloud.points.resize(3, static_cast<Index>(n));
  if (has_normals) cloud.normals.resize(3, static_cast<Index>(n));
  for (std::uint64_t row = 0; row < n; ++row) {
    next_row(file, reader, "vertices", row, n);
    const auto j = static_cast<Index>(row);
    for (Index i = 0; i < 3; ++i) cloud.points(i, j) = reader.coordinate(coordinate_name(i));
    for (Index i = 0; has_normals && i < 3; ++i) cloud.normals(i, j) = reader.number("normal");
  }

  std::vector<int> corners;
  std::vector<int> polygon;
  for (std::uint64_t row = 0; row < m; ++row) {
    next_row(file, reader, "faces", row, m);
    const std::uint64_t size = read_count(reader, "the number of corners");
    polygon.clear();
    for (std::uint64_t i = 0; i < size; ++i) {
      const std::int64_t index = reader.integer("vertex index");
      if (index < 0 || static_cast<std::uint64_t>(index) >= n) {
        reader.fail("vertex index " + std::to_string(index) + " is out of range (there are " + std::to_string(n) +
                    " vertices, counted from 0); correct the face");
      }
      polygon.push_back(static_cast<int>(index));
    }
    append_fan(polygon, corners);  // what follows on the line is the face's colour
  }
  if (reader.next_line()) reader.fail("more lines than the counts announce; correct the counts");
  cloud.faces = to_faces(corners);
  return cloud;
}

}  // namespace taut::detail
