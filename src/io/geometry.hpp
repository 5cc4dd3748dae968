#pragma once

#include <span>
#include <vector>

#include "taut/core/mesh.hpp"
#include "taut/core/types.hpp"
#include "taut/io/output_file.hpp"

namespace taut::detail {

/// What every writer is handed: a view on points, with what hangs on them. The owner checks that the shapes fit.
struct Geometry {
  PointsIn points;                           // d x n
  PointsIn normals;                          // d x n or d x 0
  Eigen::Ref<const Eigen::Matrix3Xi> faces;  // 3 x m
  std::span<const Index> line_starts;        // first point of each line, then n; empty when there are no lines
  std::span<const VertexScalar> scalars;     // n values each

  [[nodiscard]] Index dim() const { return points.rows(); }
  [[nodiscard]] Index size() const { return points.cols(); }
  [[nodiscard]] bool has_normals() const { return normals.cols() > 0; }
  [[nodiscard]] Index num_lines() const { return line_starts.empty() ? 0 : static_cast<Index>(line_starts.size()) - 1; }
  /// Entry i of point j; 0 beyond the plane.
  [[nodiscard]] double at(Index i, Index j) const { return i < dim() ? points(i, j) : 0.0; }
  [[nodiscard]] double normal_at(Index i, Index j) const { return i < dim() ? normals(i, j) : 0.0; }
};

// One function a format. The bytes go to `out`, which the caller commits.
void write_ply(OutputFile& out, const Geometry& geometry);
void write_obj(OutputFile& out, const Geometry& geometry);
void write_off(OutputFile& out, const Geometry& geometry);
void write_stl(OutputFile& out, const Geometry& geometry);
void write_vtp(OutputFile& out, const Geometry& geometry);
void write_glb(OutputFile& out, const Geometry& geometry);
void write_dxf(OutputFile& out, const Geometry& geometry);
void write_json(OutputFile& out, const Geometry& geometry);
void write_xyz(OutputFile& out, const Geometry& geometry);
void write_csv(OutputFile& out, const Geometry& geometry);
void write_npy(OutputFile& out, const PointsIn& points);

/// Appends the bytes of `value`, least significant first.
void write_raw(OutputFile& out, double value);
void write_raw(OutputFile& out, float value);
void write_raw(OutputFile& out, std::int32_t value);

/// Writes `count` numbers `entry(0)`, ..., separated.
template <class Entry>
void write_numbers(OutputFile& out, Index count, std::string_view separator, Entry entry) {
  for (Index i = 0; i < count; ++i) {
    if (i > 0) out.write(separator);
    out.write_number(entry(i));
  }
}

}  // namespace taut::detail
