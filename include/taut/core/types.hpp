#pragma once

#include <Eigen/Core>

namespace taut {

using Index = Eigen::Index;

/// A point or direction in R^d.
using Vector = Eigen::VectorXd;

/// d x n, a point per column: the memory order of a NumPy (n, d) array, so nothing is copied at that border.
using Points = Eigen::MatrixXd;

/// A point (d entries) passed in.
using VectorIn = Eigen::Ref<const Eigen::VectorXd>;

/// Points (d x n, column-major, contiguous) passed in.
using PointsIn = Eigen::Ref<const Eigen::MatrixXd>;

}  // namespace taut
