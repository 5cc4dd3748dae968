// PLY for other programs: the meshes and curves that are looked at have 32-bit floats, which all of them read (gmsh and
// vdb_tool refuse doubles), and the first number a vertex stands a second time under the name that MeshLab and others
// colour by. Points alone are data and keep their doubles; so does what 32 bits would make coarse, such as a building
// in coordinates of millions of metres.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

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

constexpr const char* kShownScalar = "quality";

/// Rounding to 32 bits moves no point by more than this part of the whole extent.
bool fits_floats(const Geometry& geometry) {
  constexpr double kFineEnough = 1e-6;  // below what a picture of a thousand pixels shows by far
  constexpr double kRounding = 6e-8;    // 2^-24, relative
  const auto extent = (geometry.points.rowwise().maxCoeff() - geometry.points.rowwise().minCoeff()).maxCoeff();
  const double largest = geometry.points.cwiseAbs().maxCoeff();
  return largest * kRounding <= kFineEnough * extent && largest <= std::numeric_limits<float>::max();
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
  const bool shown = geometry.faces.cols() > 0 || num_edges > 0;
  const bool single = shown && n > 0 && fits_floats(geometry);
  const std::string type = single ? "property float " : "property double ";
  const bool quality = geometry.faces.cols() > 0 && !geometry.scalars.empty();
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment written by Taut\nelement vertex ";
  header += std::to_string(n) + "\n";
  std::vector<std::string> names = {"x", "y", "z"};
  if (geometry.has_normals()) names.insert(names.end(), {"nx", "ny", "nz"});
  for (const VertexScalar& scalar : geometry.scalars) names.push_back(property_name(scalar.name));
  if (quality) names.emplace_back(kShownScalar);
  for (const std::string& name : names) header += type + name + "\n";
  if (geometry.faces.cols() > 0) {
    header += "element face " + std::to_string(geometry.faces.cols()) + "\nproperty list uchar int vertex_indices\n";
  }
  if (num_edges > 0) {
    header += "element edge " + std::to_string(num_edges) + "\nproperty int vertex1\nproperty int vertex2\n";
  }
  out.write(header + "end_header\n");

  const auto write = [&](double value) {
    if (single) {
      write_raw(out, static_cast<float>(value));
    } else {
      write_raw(out, value);
    }
  };
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < 3; ++i) write(geometry.at(i, j));
    for (Index i = 0; geometry.has_normals() && i < 3; ++i) write(geometry.normal_at(i, j));
    for (const VertexScalar& scalar : geometry.scalars) write(scalar.values(j));
    if (quality) write(geometry.scalars.front().values(j));
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
