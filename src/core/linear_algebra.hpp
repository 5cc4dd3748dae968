#pragma once

#include <Eigen/Core>

#include "taut/core/types.hpp"

namespace taut::detail {

// Decompositions of small dense matrices, by Eigen. They are compiled here once: as templates in every source that asks
// for one they took a third of the library's build.

/// A symmetric matrix A = V diag(values) V^T, of which the lower triangle is read.
template <class Matrix>
struct SymmetricEigen {
  Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1> values;  ///< ascending
  Matrix vectors;                                              ///< orthonormal, a column each
};
[[nodiscard]] SymmetricEigen<Eigen::Matrix2d> symmetric_eigen(const Eigen::Matrix2d& a);
[[nodiscard]] SymmetricEigen<Eigen::Matrix3d> symmetric_eigen(const Eigen::Matrix3d& a);
[[nodiscard]] SymmetricEigen<Eigen::MatrixXd> symmetric_eigen(const Eigen::MatrixXd& a);
/// The values alone.
[[nodiscard]] Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& a);
[[nodiscard]] Vector symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// A^-1 B, A square and regular.
[[nodiscard]] Eigen::MatrixXd solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// d x (d - m): an orthonormal basis of all that stands at a right angle to m independent columns (d x m). It depends
/// on the columns smoothly but for jumps of sign.
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const PointsIn& columns);

/// The thin factorisation A = Q R of d x k independent columns, d >= k.
struct ThinQr {
  Eigen::MatrixXd q;  ///< d x k, orthonormal
  Eigen::MatrixXd r;  ///< k x k, upper triangle
};
[[nodiscard]] ThinQr thin_qr(const PointsIn& a);

/// d x r: an orthonormal basis of the span of the columns, r their rank to rounding.
[[nodiscard]] Eigen::MatrixXd span_basis(const PointsIn& columns);

/// A^+ b: of all x with the least |A x - b| the shortest. Pivots below `threshold` of the largest count as zero; 0 =
/// rounding.
[[nodiscard]] Vector least_squares(const PointsIn& a, const VectorIn& b, double threshold = 0);

[[nodiscard]] double determinant(const Eigen::MatrixXd& a);

/// Descending.
[[nodiscard]] Vector singular_values(const Eigen::MatrixXd& a);

}  // namespace taut::detail
