// VTK's XML PolyData (VTK File Formats, "XML File Formats"): arrays inline in base64, each preceded by its size in
// bytes as a 64-bit number, size and data encoded as one. Text arrays would be readable, but VTK stops at the first
// "nan".

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "io/geometry.hpp"

namespace taut::detail {
namespace {

/// Base64 of a stream of bytes.
class Base64 {
 public:
  explicit Base64(OutputFile& out) : out_(out) {}

  template <class T>
  void add(T value) {
    std::array<unsigned char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    for (const unsigned char byte : raw) {
      group_ = group_ << 8 | byte;
      if (++filled_ == 3) emit(4);
    }
  }

  void finish() {
    if (filled_ == 0) return;
    const int digits = filled_ + 1;
    group_ <<= 8 * (3 - filled_);
    emit(digits);
  }

 private:
  void emit(int digits) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<char, 4> text = {'=', '=', '=', '='};
    for (int i = 0; i < digits; ++i) text[static_cast<std::size_t>(i)] = kDigits[group_ >> (18 - 6 * i) & 63];
    out_.write({text.data(), 4});
    group_ = 0;
    filled_ = 0;
  }

  OutputFile& out_;
  std::uint32_t group_ = 0;
  int filled_ = 0;
};

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return out;
}

/// A DataArray of `components` x `count` entries, `entry(i, j)`, all of type T.
template <class T, class Entry>
void write_array(OutputFile& out, const std::string& name, Index components, Index count, Entry entry) {
  out.write(std::string("<DataArray type=\"") + (std::is_same_v<T, double> ? "Float64" : "Int64") + "\" Name=\"" +
            xml_escaped(name) + "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"binary\">\n");
  Base64 base64(out);
  base64.add(static_cast<std::uint64_t>(components * count) * sizeof(T));
  for (Index j = 0; j < count; ++j) {
    for (Index i = 0; i < components; ++i) base64.add(static_cast<T>(entry(i, j)));
  }
  base64.finish();
  out.write("\n</DataArray>\n");
}

/// Cells of one kind: cell c has the points listed from ends[c-1] to ends[c].
template <class Connectivity, class Ends>
void write_cells(OutputFile& out, const std::string& tag, Index entries, Connectivity connectivity, Index cells,
                 Ends ends) {
  out.write("<" + tag + ">\n");
  write_array<std::int64_t>(out, "connectivity", 1, entries, [&](Index, Index j) { return connectivity(j); });
  write_array<std::int64_t>(out, "offsets", 1, cells, [&](Index, Index c) { return ends(c); });
  out.write("</" + tag + ">\n");
}

}  // namespace

void write_vtp(OutputFile& out, const Geometry& geometry) {
  const Index n = geometry.size();
  const Index m = geometry.faces.cols();
  const Index num_lines = geometry.num_lines();
  const Index num_verts = m == 0 && num_lines == 0 ? n : 0;  // a cloud shows only if its points are cells
  out.write(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
      std::to_string(n) + "\" NumberOfVerts=\"" + std::to_string(num_verts) + "\" NumberOfLines=\"" +
      std::to_string(num_lines) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(m) + "\">\n");

  out.write("<PointData>\n");
  if (geometry.has_normals()) {
    write_array<double>(out, "Normals", 3, n, [&](Index i, Index j) { return geometry.normal_at(i, j); });
  }
  for (const VertexScalar& scalar : geometry.scalars) {
    write_array<double>(out, scalar.name, 1, n, [&](Index, Index j) { return scalar.values(j); });
  }
  out.write("</PointData>\n<Points>\n");
  write_array<double>(out, "Points", 3, n, [&](Index i, Index j) { return geometry.at(i, j); });
  out.write("</Points>\n");

  if (num_verts > 0) {
    write_cells(
        out, "Verts", n, [](Index j) { return j; }, n, [](Index c) { return c + 1; });
  }
  if (num_lines > 0) {
    write_cells(
        out, "Lines", n, [](Index j) { return j; }, num_lines,
        [&](Index c) { return geometry.line_starts[static_cast<std::size_t>(c) + 1]; });
  }
  if (m > 0) {
    write_cells(
        out, "Polys", 3 * m, [&](Index j) { return geometry.faces(j % 3, j / 3); }, m,
        [](Index c) { return 3 * (c + 1); });
  }
  out.write("</Piece>\n</PolyData>\n</VTKFile>\n");
}

}  // namespace taut::detail
