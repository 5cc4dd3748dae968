// Points as rows: .csv, .xyz and .npy.

#include <string>

#include "io/geometry.hpp"
#include "taut/io/output_file.hpp"

namespace taut::detail {
namespace {

/// x y z (nx ny nz) in the plane and in space, x1 x2 ... (n1 n2 ...) elsewhere.
std::string label(Index i, Index dim, bool of_normal) {
  if (dim <= 3) return std::string(of_normal ? "n" : "") + "xyz"[i];
  return std::string(1, of_normal ? 'n' : 'x').append(std::to_string(i + 1));
}

/// In quotes where it would break the line otherwise.
std::string csv_field(const std::string& name) {
  if (name.find_first_of(",;\"\n\r#") == std::string::npos && !name.empty()) return name;
  std::string out = "\"";
  for (const char c : name) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' || c == '#' ? ' ' : c;
  }
  return out + "\"";
}

}  // namespace

void write_csv(OutputFile& out, const Geometry& geometry) {
  const Index d = geometry.dim();
  const bool names_lines = geometry.num_lines() > 1;
  std::string header = names_lines ? "line" : "";
  const auto add = [&](const std::string& name) { header += (header.empty() ? "" : ",") + name; };
  for (Index i = 0; i < d; ++i) add(label(i, d, false));
  for (Index i = 0; geometry.has_normals() && i < d; ++i) add(label(i, d, true));
  for (const VertexScalar& scalar : geometry.scalars) add(csv_field(scalar.name));
  out.write(header + "\n");

  std::size_t line = 0;
  for (Index j = 0; j < geometry.size(); ++j) {
    if (names_lines) {
      while (j >= geometry.line_starts[line + 1]) ++line;
      out.write_number(static_cast<std::ptrdiff_t>(line));
      out.write(",");
    }
    const Index num_normal = geometry.has_normals() ? d : 0;
    const auto num_scalars = static_cast<Index>(geometry.scalars.size());
    write_numbers(out, d + num_normal + num_scalars, ",", [&](Index i) {
      if (i < d) return geometry.points(i, j);
      if (i < d + num_normal) return geometry.normals(i - d, j);
      return geometry.scalars[static_cast<std::size_t>(i - d - num_normal)].values(j);
    });
    out.write("\n");
  }
}

void write_xyz(OutputFile& out, const Geometry& geometry) {
  for (Index j = 0; j < geometry.size(); ++j) {
    write_numbers(out, geometry.has_normals() ? 6 : 3, " ",
                  [&](Index i) { return i < 3 ? geometry.at(i, j) : geometry.normal_at(i - 3, j); });
    out.write("\n");
  }
}

void write_npy(OutputFile& out, const PointsIn& points) {
  write_npy_header(out, {points.cols(), points.rows()});
  for (Index j = 0; j < points.cols(); ++j) {
    for (Index i = 0; i < points.rows(); ++i) write_raw(out, points(i, j));
  }
}

}  // namespace taut::detail
