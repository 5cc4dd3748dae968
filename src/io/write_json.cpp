#include <cmath>
#include <string>

#include "io/geometry.hpp"

namespace taut::detail {
namespace {

std::string json_string(const std::string& text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (byte < ' ') {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// JSON has no nan and no infinity: null stands for them.
void write_value(OutputFile& out, double value) {
  if (std::isfinite(value)) {
    out.write_number(value);
  } else {
    out.write("null");
  }
}

/// [entry(0),entry(1),...], each written by `write_entry(i)`.
template <class WriteEntry>
void write_list(OutputFile& out, Index count, WriteEntry write_entry) {
  out.write("[");
  for (Index i = 0; i < count; ++i) {
    if (i > 0) out.write(",");
    write_entry(i);
  }
  out.write("]");
}

void write_columns(OutputFile& out, const PointsIn& points) {
  write_list(out, points.cols(),
             [&](Index j) { write_list(out, points.rows(), [&](Index i) { write_value(out, points(i, j)); }); });
}

}  // namespace

void write_json(OutputFile& out, const Geometry& geometry) {
  out.write("{\"points\":");
  write_columns(out, geometry.points);
  if (geometry.has_normals()) {
    out.write(",\n\"normals\":");
    write_columns(out, geometry.normals);
  }
  if (geometry.faces.cols() > 0) {
    out.write(",\n\"faces\":");
    write_list(out, geometry.faces.cols(), [&](Index f) {
      write_list(out, 3, [&](Index i) { out.write_number(std::ptrdiff_t{geometry.faces(i, f)}); });
    });
  }
  if (geometry.num_lines() > 0) {
    out.write(",\n\"lines\":");
    write_list(out, geometry.num_lines(), [&](Index l) {
      const auto line = static_cast<std::size_t>(l);
      const Index first = geometry.line_starts[line];
      write_list(out, geometry.line_starts[line + 1] - first, [&](Index i) { out.write_number(first + i); });
    });
  }
  if (!geometry.scalars.empty()) {
    out.write(",\n\"scalars\":{");
    for (std::size_t s = 0; s < geometry.scalars.size(); ++s) {
      const VertexScalar& scalar = geometry.scalars[s];
      if (s > 0) out.write(",\n");
      out.write(json_string(scalar.name) + ":");
      write_list(out, scalar.values.size(), [&](Index j) { write_value(out, scalar.values(j)); });
    }
    out.write("}");
  }
  out.write("}\n");
}

}  // namespace taut::detail
