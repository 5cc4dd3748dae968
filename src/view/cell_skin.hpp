#pragma once

#include "view/stage.hpp"

namespace taut::detail {

/// The outside of a set of cells: those faces of its cubes that no other cube shares, and their edges. For d = 2 the
/// squares themselves.
struct CellSkin {
  Eigen::Matrix3Xf positions;  ///< four a face, each face its own
  Eigen::Matrix3Xf normals;
  Eigen::Matrix3Xi faces;
  Eigen::Matrix2Xi edges;
};
CellSkin make_cell_skin(const Stage& stage);

}  // namespace taut::detail
