#pragma once

#include <Eigen/Core>

namespace taut::detail {

/// The two bases of a panel of the exponential map: Chebyshev polynomials in the angle over kRays rays, and along the
/// rays Gauss collocation with kStages nodes, whose positions are polynomials of degree kStages + 1. Computed once, in
/// extended precision. tau = 0 .. 1 along a step, xi = 2 tau - 1; alpha = -1 .. 1 across the rays.
struct PanelBasis {
  /// Even, so that the middle of a panel is no node. Between 8 and 14 what a field costs varies by a quarter; at 12 x
  /// 10 it is least on the sphere, the torus and the tangle cube together (docs/measured/field.md).
  static constexpr int kRays = 12;
  static constexpr int kStages = 10;
  static constexpr int kSeries = kStages + 2;  ///< Chebyshev coefficients of a position along a step

  using StageRow = Eigen::Matrix<double, 1, kStages>;
  using StageSquare = Eigen::Matrix<double, kStages, kStages>;
  using RaySquare = Eigen::Matrix<double, kRays, kRays>;

  // Along the rays. An acceleration is its values at the stages.
  StageRow node;                                         ///< in (0, 1), ascending
  StageSquare once;                                      ///< column i: weights of int_0^node_i a
  StageSquare twice;                                     ///< column i: weights of int_0^node_i int a
  StageRow end_once;                                     ///< weights of int_0^1 a
  StageRow end_twice;                                    ///< weights of int_0^1 int a
  StageSquare to_legendre;                               ///< column n: weights of the n-th Legendre coefficient
  Eigen::Matrix<double, kStages, kSeries> twice_series;  ///< column n: weights of Chebyshev coefficient n of int int a

  // Across the rays. Values at the nodes, ascending, are a column.
  Eigen::Matrix<double, kRays, 1> ray;  ///< nodes in (-1, 1): zeros of the Chebyshev polynomial
  RaySquare ray_series;                 ///< row n: weights of the n-th Chebyshev coefficient
  RaySquare ray_slope;                  ///< row i: weights of d/d alpha at node i
  RaySquare half[2];  ///< row i: weights of the value at node i of the lower (alpha < 0) and the upper half

  [[nodiscard]] static const PanelBasis& tables();
};

/// T_0 .. T_{n-1} at t, and their derivatives.
inline void chebyshev(double t, int n, double* value) {
  value[0] = 1;
  value[1] = t;
  for (int i = 2; i < n; ++i) value[i] = 2 * t * value[i - 1] - value[i - 2];
}
inline void chebyshev_slopes(double t, int n, double* value, double* slope) {
  chebyshev(t, n, value);
  slope[0] = 0;
  slope[1] = 1;
  for (int i = 2; i < n; ++i) slope[i] = 2 * value[i - 1] + 2 * t * slope[i - 1] - slope[i - 2];
}

/// P_0 .. P_{kStages-1} at xi = 2 tau - 1, for any tau.
void legendre_at(double tau, double* value);

}  // namespace taut::detail
