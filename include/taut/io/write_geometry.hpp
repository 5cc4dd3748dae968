#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "taut/core/mesh.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut {

// Every writer chooses the format by the extension, writes whole files or none (see OutputFile), and keeps doubles as
// they are: text is the shortest that reads back the same, binary is float64. The exceptions are `.stl` and `.glb`,
// whose formats have 32-bit floats (in `.glb` about the middle of the box). Throws InvalidArgument when the arrays'
// shapes do not fit together, IoError for the rest (an extension the kind of data has no format for names those it
// has).

/// `.ply` (binary), `.obj`, `.off`, `.stl` (binary), `.vtp`, `.glb`, `.csv` (vertices only), `.npy` (vertices only),
/// `.json`. Scalars go to `.ply`, `.vtp`, `.csv` and `.json`; normals to `.ply`, `.obj`, `.off`, `.vtp`, `.csv` and
/// `.json`.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// `.ply` (edges), `.obj` (lines), `.vtp`, `.glb`, `.dxf`, `.csv` (a leading column `line` when there are several),
/// `.npy` (one line only),
/// `.json`. Curves outside R^3 go to `.csv`, `.npy` and `.json`; planar ones are given z = 0 elsewhere.
/// `normals` (d x all points, or none) and scalars go to `.ply`, `.vtp`, `.csv` and `.json`.
void write_polylines(const std::filesystem::path& path, const Polylines& polylines,
                     const PointsIn& normals = Points(0, 0));

/// `.ply`, `.obj`, `.off`, `.vtp`, `.xyz`, `.csv`, `.npy` (points only), `.json`. d != 3 as for polylines.
void write_point_cloud(const std::filesystem::path& path, const PointCloud& cloud);

/// `.csv` with a header of the names, or `.npy` of shape (n, number of columns). All columns have the same length.
void write_table(const std::filesystem::path& path, const std::vector<VertexScalar>& columns);

/// `.npy` of shape (columns of `matrix`, rows of `matrix`), or `.csv` without a header, a column of `matrix` a line:
/// points d x n go out as (n, d).
void write_matrix(const std::filesystem::path& path, const PointsIn& matrix);

/// Extensions the functions above know, lower case with their dot.
[[nodiscard]] const std::vector<std::string>& mesh_output_extensions();
[[nodiscard]] const std::vector<std::string>& polyline_output_extensions();

}  // namespace taut
