#include "taut/io/write_geometry.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "io/geometry.hpp"
#include "io/input_file.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace detail {
namespace {

/// What a format can hold.
struct OutputFormat {
  std::string_view extension;
  void (*write)(OutputFile&, const Geometry&);
  bool meshes;
  bool lines;
  bool clouds;
  bool any_dimension;
  bool finite = false;  // has no word for infinity and not-a-number
};

void write_points_only(OutputFile& out, const Geometry& geometry) { write_npy(out, geometry.points); }

constexpr std::array kFormats = {
    OutputFormat{".ply", write_ply, true, true, true, false},
    OutputFormat{".obj", write_obj, true, true, true, false},
    OutputFormat{".off", write_off, true, false, true, false},
    OutputFormat{".stl", write_stl, true, false, false, false},
    OutputFormat{".vtp", write_vtp, true, true, true, false},
    OutputFormat{".glb", write_glb, true, true, false, false, true},
    OutputFormat{".dxf", write_dxf, false, true, false, false, true},
    OutputFormat{".xyz", write_xyz, false, false, true, false},
    OutputFormat{".csv", write_csv, true, true, true, true},
    OutputFormat{".npy", write_points_only, true, true, true, true},
    OutputFormat{".json", write_json, true, true, true, true},
};

using Kind = bool OutputFormat::*;

std::vector<std::string> extensions_of(Kind kind) {
  std::vector<std::string> list;
  for (const OutputFormat& format : kFormats) {
    if (format.*kind) list.emplace_back(format.extension);
  }
  return list;
}

const OutputFormat& output_format(const std::filesystem::path& path, Kind kind, std::string_view plural) {
  const std::string extension = lower_extension(path);
  for (const OutputFormat& format : kFormats) {
    if (format.extension == extension && format.*kind) return format;
  }
  std::string known;
  for (const std::string& each : extensions_of(kind)) known += (known.empty() ? "" : " ") + each;
  const std::string problem = extension.empty() ? "the name has no extension" : "extension " + quote(extension);
  throw IoError(path.string(), problem + "; " + std::string(plural) + " are written to " + known);
}

void check_shapes(const Geometry& geometry) {
  const Index n = geometry.size();
  if (geometry.has_normals() && (geometry.normals.cols() != n || geometry.normals.rows() != geometry.dim())) {
    throw InvalidArgument("normals: " + std::to_string(geometry.normals.cols()) + " for " +
                          counted(static_cast<std::size_t>(n), "point") + "; give as many, or none");
  }
  for (const VertexScalar& scalar : geometry.scalars) {
    if (scalar.values.size() == n) continue;
    throw InvalidArgument("scalar '" + scalar.name + "' has " +
                          counted(static_cast<std::size_t>(scalar.values.size()), "value") + " for " +
                          counted(static_cast<std::size_t>(n), "point") + "; give one a point");
  }
  if (geometry.faces.size() > 0 && (geometry.faces.minCoeff() < 0 || geometry.faces.maxCoeff() >= n)) {
    throw InvalidArgument("faces: an index is out of range (there are " +
                          counted(static_cast<std::size_t>(n), "vertex") + ")");
  }
}

void write_geometry(const std::filesystem::path& path, const OutputFormat& format, const Geometry& geometry) {
  check_shapes(geometry);
  if (!format.any_dimension && (geometry.dim() < 2 || geometry.dim() > 3) && geometry.size() > 0) {
    throw IoError(path.string(), std::string(format.extension) + " holds points in space, these have " +
                                     std::to_string(geometry.dim()) + " coordinates; write .csv, .npy or .json");
  }
  if (format.finite && !geometry.points.allFinite()) {
    throw InvalidArgument("a point is not finite, which " + std::string(format.extension) + " has no word for");
  }
  OutputFile out(path);
  format.write(out, geometry);
  out.commit();
}

/// 32-bit counts in the format, or indices in the arrays.
constexpr Index kMostIndexed = 2147483647;

}  // namespace
}  // namespace detail

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  const auto& format = detail::output_format(path, &detail::OutputFormat::meshes, "meshes");
  detail::write_geometry(path, format, {mesh.vertices, mesh.normals, mesh.faces, {}, mesh.scalars});
}

void write_polylines(const std::filesystem::path& path, const Polylines& polylines, const PointsIn& normals) {
  const auto& format = detail::output_format(path, &detail::OutputFormat::lines, "curves");
  const Index dim = polylines.lines.empty() ? 3 : polylines.lines.front().rows();
  if (polylines.num_points() > detail::kMostIndexed) throw InvalidArgument("polylines: more than 2^31 - 1 points");
  Points points(dim, polylines.num_points());
  std::vector<Index> starts = {0};
  for (const Points& line : polylines.lines) {
    if (line.rows() != dim) {
      throw InvalidArgument("polylines: one has " + std::to_string(line.rows()) + " coordinates a point, another " +
                            std::to_string(dim) + "; give them one dimension");
    }
    points.middleCols(starts.back(), line.cols()) = line;
    starts.push_back(starts.back() + line.cols());
  }
  if (format.extension == ".npy" && polylines.lines.size() > 1) {
    throw IoError(path.string(), ".npy holds one curve, there are " + std::to_string(polylines.lines.size()) +
                                     "; write .csv, .json or .vtp");
  }
  detail::write_geometry(path, format, {points, normals, Eigen::Matrix3Xi(3, 0), starts, polylines.scalars});
}

void write_point_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
  const bool has_faces = cloud.faces.cols() > 0;
  const auto& format = has_faces ? detail::output_format(path, &detail::OutputFormat::meshes, "meshes")
                                 : detail::output_format(path, &detail::OutputFormat::clouds, "point clouds");
  detail::write_geometry(path, format, {cloud.points, cloud.normals, cloud.faces, {}, {}});
}

void write_table(const std::filesystem::path& path, const std::vector<VertexScalar>& columns) {
  const std::string extension = detail::lower_extension(path);
  if (extension != ".csv" && extension != ".npy") {
    throw IoError(path.string(), "extension " + detail::quote(extension) + "; tables are written to .csv .npy");
  }
  const Index n = columns.empty() ? 0 : columns.front().values.size();
  Points rows(static_cast<Index>(columns.size()), n);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].values.size() != n) {
      throw InvalidArgument("column '" + columns[c].name + "' has " + std::to_string(columns[c].values.size()) +
                            " values where the first has " + std::to_string(n) + "; give them one length");
    }
    rows.row(static_cast<Index>(c)) = columns[c].values.transpose();
  }
  OutputFile out(path);
  if (extension == ".csv") {
    detail::write_csv(out, {Points(0, n), Points(0, 0), Eigen::Matrix3Xi(3, 0), {}, columns});
  } else {
    detail::write_npy(out, rows);
  }
  out.commit();
}

void write_matrix(const std::filesystem::path& path, const PointsIn& matrix) {
  const std::string extension = detail::lower_extension(path);
  if (extension != ".csv" && extension != ".npy") {
    throw IoError(path.string(), "extension " + detail::quote(extension) + "; matrices are written to .csv .npy");
  }
  OutputFile out(path);
  if (extension == ".npy") {
    detail::write_npy(out, matrix);
  } else {
    for (Index j = 0; j < matrix.cols(); ++j) {
      detail::write_numbers(out, matrix.rows(), ",", [&](Index i) { return matrix(i, j); });
      out.write("\n");
    }
  }
  out.commit();
}

const std::vector<std::string>& mesh_output_extensions() {
  static const std::vector<std::string> extensions = detail::extensions_of(&detail::OutputFormat::meshes);
  return extensions;
}

const std::vector<std::string>& polyline_output_extensions() {
  static const std::vector<std::string> extensions = detail::extensions_of(&detail::OutputFormat::lines);
  return extensions;
}

}  // namespace taut
