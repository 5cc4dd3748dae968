#pragma once

#include <Eigen/Core>

#include "taut/core/types.hpp"

namespace taut::detail {

// What a sample's neighbours say about the sheet that it lies on: a plane, a quadric over it. In the plane and in
// space; no memory is taken from the heap, for a scan has a million samples.

/// Most neighbours that are looked at, and most terms of a model of them.
inline constexpr int kMostAround = 48;
inline constexpr int kMostTerms = 16;

/// Points around a sample, d x n, d = 2 or 3.
using Around = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, kMostAround>;
/// A number for each of them, 1 x n.
using AroundRow = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMostAround>;
/// The terms of a model at each of them, m x n.
using AroundTerms = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostTerms, kMostAround>;
/// The terms at one point, or their coefficients.
using TermVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostTerms, 1>;
/// A direction, and an orthonormal basis, of the plane or space.
using Direction = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;
using Axes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// Orthonormal axes of points (d x n) by how far they spread along them from their mean, the least first: the normal
/// of the plane through them.
[[nodiscard]] Axes axes_by_spread(const PointsIn& around);

/// Of a quadric over m tangents: 1, t_a and t_a t_b, b <= a.
[[nodiscard]] constexpr Index num_quadric_terms(Index m) { return 1 + m + m * (m + 1) / 2; }
/// They themselves at a place t (m).
[[nodiscard]] TermVector quadric_terms(const VectorIn& place);

/// The coefficients c of the least sum over the samples of (value - c . terms)^2 + kRidge |c|^2, so n times the ridge.
/// `terms`: m x n, m at most kMostTerms.
[[nodiscard]] TermVector fit_terms(const PointsIn& terms, const Eigen::Ref<const Eigen::RowVectorXd>& values);

/// Where samples in rows leave a term open: far below what noise or shape asks for, far above rounding.
inline constexpr double kRidge = 1e-10;

}  // namespace taut::detail
