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

/// Points (d x n, a point contiguous) passed in. A block of a larger matrix is taken without a copy, and then leaves
/// gaps between its columns: `data()` alone does not tell where a point begins.
using PointsIn = Eigen::Ref<const Eigen::MatrixXd>;

}  // namespace taut
