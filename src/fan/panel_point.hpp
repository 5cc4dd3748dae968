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

/// The first terms of the series alone: what most of the way to a point is gone on. Of 4 x 4, 4 x 6, 8 x 6 and 8 x 8
/// terms no choice was quicker than the third on any of five surfaces (docs/measured/field.md).
inline constexpr int kSketchAcross = 8;
inline constexpr int kSketchAlong = 6;
[[nodiscard]] PanelPoint panel_sketch(const ExpPatch& patch, double alpha, double beta);

/// Sum of the sizes of the terms that the sketch leaves out, model units.
[[nodiscard]] double sketch_error(const ExpPatch& patch);

}  // namespace taut::detail
