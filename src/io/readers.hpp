#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/input_file.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// Reads what `read_point_cloud` promises from bytes already in memory; the path's extension decides the format.
[[nodiscard]] PointCloud parse_point_cloud(InputFile file, std::optional<Index> dim = {});

// One function a format. Each throws IoError on anything wrong; `read_point_cloud` then checks what they share.
[[nodiscard]] PointCloud read_ply(const InputFile& file);
[[nodiscard]] PointCloud read_obj(const InputFile& file);
[[nodiscard]] PointCloud read_off(const InputFile& file);
[[nodiscard]] PointCloud read_stl(const InputFile& file);
[[nodiscard]] PointCloud read_pcd(const InputFile& file);
[[nodiscard]] PointCloud read_npy(const InputFile& file);
[[nodiscard]] PointCloud read_las(const InputFile& file);
[[nodiscard]] PointCloud read_vtk_points(const InputFile& file);
[[nodiscard]] PointCloud read_vtk_xml(const InputFile& file);

/// Lines of numbers: what `.xyz`, `.pts`, `.asc`, `.txt`, `.pwn`, `.csv` and `.tsv` have in common.
enum class ColumnFormat {
  spatial,  ///< x y z first, whatever follows
  pwn,      ///< the same, or points and then normals, three numbers a line
  any,      ///< a coordinate a column, in any dimension
};
struct ColumnOptions {
  std::optional<Index> dim;  ///< how many columns are coordinates, where no header names them
  bool whole_lines = false;  ///< then `dim` columns are all there may be
};
[[nodiscard]] PointCloud read_columns(const InputFile& file, ColumnFormat format, const ColumnOptions& options = {});

/// d x n from numbers that stand point by point.
[[nodiscard]] inline Points to_points(const std::vector<double>& values, Index dim) {
  return Eigen::Map<const Points>(values.data(), dim, static_cast<Index>(values.size()) / dim);
}

/// 3 x m from corners that stand triangle by triangle.
[[nodiscard]] inline Eigen::Matrix3Xi to_faces(const std::vector<int>& corners) {
  return Eigen::Map<const Eigen::Matrix3Xi>(corners.data(), 3, static_cast<Index>(corners.size()) / 3);
}

/// Appends a polygon as a fan of triangles around its first corner.
inline void append_fan(const std::vector<int>& polygon, std::vector<int>& corners) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    corners.push_back(polygon[0]);
    corners.push_back(polygon[i - 1]);
    corners.push_back(polygon[i]);
  }
}

/// Most points a cloud may have: faces index them by `int`.
inline constexpr std::uint64_t kMostPoints = std::numeric_limits<int>::max();

/// Refuses a declared count that the file is too small to hold, before anything is allocated for it. `bytes_each` is
/// the least an entry takes; `where` names what declares it.
void check_declared(const InputFile& file, std::uint64_t count, std::uint64_t bytes_each, std::uint64_t available,
                    const std::string& where);

/// Leaves out points that stand for a missing value, such as 0,0,0 among coordinates of millions, and says which.
void drop_missing_values(const InputFile& file, PointCloud& cloud);

/// "coordinate x" .. "coordinate z", or "coordinate 7"
[[nodiscard]] std::string coordinate_name(Index i);

}  // namespace taut::detail
