#pragma once

#include <Eigen/Core>

#include "taut/core/types.hpp"

namespace taut {

/// Points as a scanner or a file gives them.
struct PointCloud {
  Points points;           ///< d x n
  Points normals;          ///< d x n, pointing outwards, any length, a zero column = unknown; d x 0 when there are none
  Eigen::Matrix3Xi faces;  ///< 3 x m, indices into `points`; 3 x 0 when there are none (d = 3 only)

  [[nodiscard]] Index dim() const { return points.rows(); }
  [[nodiscard]] Index size() const { return points.cols(); }
  [[nodiscard]] bool has_normals() const { return normals.cols() == points.cols() && points.cols() > 0; }
};

}  // namespace taut
