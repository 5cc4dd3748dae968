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

/// A closed axis-aligned box in R^d.
struct Box {
  Vector lower;  ///< d
  Vector upper;  ///< d, nowhere below `lower`

  [[nodiscard]] Index dim() const { return lower.size(); }
  [[nodiscard]] Vector extent() const { return upper - lower; }
  /// Length of the diagonal: the size a relative tolerance is measured against.
  [[nodiscard]] double diagonal() const { return extent().norm(); }
  [[nodiscard]] bool contains(const VectorIn& x) const {
    return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  }
};

/// What two boxes that meet have in common.
[[nodiscard]] inline Box intersection(const Box& a, const Box& b) {
  return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)};
}

}  // namespace taut
