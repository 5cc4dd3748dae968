#pragma once

#include <Eigen/Core>

#include "fan/exp_patch.hpp"

namespace taut::detail {

/// A point of a panel and what it becomes to first order.
struct PanelPoint {
  Eigen::Vector3d x;
  Eigen::Vector3d across;  ///< d x / d alpha
  Eigen::Vector3d along;   ///< d x / d beta
};

/// The series of a patch summed at (alpha, beta). The same bits on every instruction set.
[[nodiscard]] PanelPoint panel_point(const ExpPatch& patch, double alpha, double beta);

}  // namespace taut::detail
