#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "io/geometry.hpp"

namespace taut::detail {
namespace {

/// A scalar's name as one word: a header is split at blanks.
std::string property_name(const std::string& name) {
  std::string word = name;
  for (char& c : word) {
    if (static_cast<unsigned char>(c) <= ' ') c = '_';
  }
  return word.empty() ? "scalar" : word;
}

template <class T>
void write_bytes(OutputFile& out, T value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  out.write({raw.data(), raw.size()});
}

}  // namespace

void write_raw(OutputFile& out, double value) { write_bytes(out, value); }
void write_raw(OutputFile& out, float value) { write_bytes(out, value); }
void write_raw(OutputFile& out, std::int32_t value) { write_bytes(out, value); }

void write_ply(OutputFile& out, const Geometry& geometry) {
  const Index n = geometry.size();
  Index num_edges = 0;
  for (std::size_t l = 1; l < geometry.line_starts.size(); ++l) {
    num_edges += std::max<Index>(geometry.line_starts[l] - geometry.line_starts[l - 1] - 1, 0);
  }
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment written by Taut\nelement vertex ";
  header += std::to_string(n) + "\nproperty double x\nproperty double y\nproperty double z\n";
  if (geometry.has_normals()) header += "property double nx\nproperty double ny\nproperty double nz\n";
  for (const VertexScalar& scalar : geometry.scalars) header += "property double " + property_name(scalar.name) + "\n";
  if (geometry.faces.cols() > 0) {
    header += "element face " + std::to_string(geometry.faces.cols()) + "\nproperty list uchar int vertex_indices\n";
  }
  if (num_edges > 0) {
    header += "element edge " + std::to_string(num_edges) + "\nproperty int vertex1\nproperty int vertex2\n";
  }
  out.write(header + "end_header\n");

  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < 3; ++i) write_raw(out, geometry.at(i, j));
    for (Index i = 0; geometry.has_normals() && i < 3; ++i) write_raw(out, geometry.normal_at(i, j));
    for (const VertexScalar& scalar : geometry.scalars) write_raw(out, scalar.values(j));
  }
  for (Index f = 0; f < geometry.faces.cols(); ++f) {
    out.write("\x03");
    for (Index i = 0; i < 3; ++i) write_raw(out, geometry.faces(i, f));
  }
  for (Index l = 0; l < geometry.num_lines(); ++l) {
    const auto line = static_cast<std::size_t>(l);
    for (Index j = geometry.line_starts[line]; j + 1 < geometry.line_starts[line + 1]; ++j) {
      write_raw(out, static_cast<std::int32_t>(j));
      write_raw(out, static_cast<std::int32_t>(j + 1));
    }
  }
}

}  // namespace taut::detail
