#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "taut/core/types.hpp"

namespace taut {

/// One number a vertex under the name that files and pages show it by ("distance").
struct VertexScalar {
  std::string name;
  Vector values;  ///< one a vertex; NaN = no value there
};

/// Triangles in space: what is meshed, drawn and written to files.
struct TriangleMesh {
  Points vertices = Points(3, 0);  ///< 3 x n, model units
  Eigen::Matrix3Xi faces;          ///< 3 x m, indices into `vertices`, counter-clockwise seen from outside
  Points normals = Points(3, 0);   ///< 3 x n, unit, pointing outwards; 3 x 0 when there are none
  std::vector<VertexScalar> scalars;

  [[nodiscard]] bool has_normals() const { return normals.cols() == vertices.cols() && vertices.cols() > 0; }
};

/// Curves in R^d, each an open chain of points (a closed one repeats its first point at its end).
struct Polylines {
  std::vector<Points> lines;          ///< each d x n_i, the same d
  std::vector<VertexScalar> scalars;  ///< one value a point, the lines' points one after the other

  [[nodiscard]] Index num_points() const {
    Index n = 0;
    for (const Points& line : lines) n += line.cols();
    return n;
  }
};

}  // namespace taut
