#pragma once

#include <Eigen/Core>

namespace taut::detail {

/// The tables of Gauss collocation with `kStages` nodes on a step 0 <= tau <= 1, computed once in extended precision.
/// An acceleration a(tau) is its values at the nodes, or the coefficients of its Legendre series in xi = 2 tau - 1.
///
/// Check points are the kStages + 1 Lobatto points: both ends of the step, and one point between any two nodes. There
/// the defect of a collocation polynomial shows; quadrature over nodes and check points together, with the defect zero
/// at the nodes, gives the error of the step (as a Gauss-Kronrod pair does for a plain integral).
struct GaussCollocation {
  static constexpr int kStages = 8;
  static constexpr int kChecks = kStages + 1;

  using Square = Eigen::Matrix<double, kStages, kStages>;
  using Row = Eigen::Matrix<double, 1, kStages>;

  Row node;            ///< in (0, 1), ascending
  Square once;         ///< column i: weights of int_0^node_i a
  Square twice;        ///< column i: weights of int_0^node_i int a
  Row end_once;        ///< weights of int_0^1 a
  Row end_twice;       ///< weights of int_0^1 (1 - tau) a
  Square to_legendre;  ///< column n: weights of the n-th Legendre coefficient

  Eigen::Matrix<double, 1, kChecks> check;              ///< from 0 to 1, ascending
  Eigen::Matrix<double, kStages, kChecks> check_value;  ///< column g: weights of a(check_g)
  Eigen::Matrix<double, kStages, kChecks> check_once;   ///< of int_0^check_g a
  Eigen::Matrix<double, kStages, kChecks> check_twice;  ///< of int_0^check_g int a
  Eigen::Matrix<double, 3, kChecks> defect_moment;      ///< row m: weights of int_0^1 defect P_m(xi)

  /// P_0 .. P_{kStages - 1} at xi = 2 tau - 1, for any tau.
  static void legendre(double tau, Eigen::Ref<Eigen::Matrix<double, kStages, 1>> values);
  /// int_0^tau P_n and int_0^tau int P_n.
  static void legendre_integrals(double tau, Eigen::Ref<Eigen::Matrix<double, kStages, 1>> first,
                                 Eigen::Ref<Eigen::Matrix<double, kStages, 1>> second);

  [[nodiscard]] static const GaussCollocation& tables();
};

}  // namespace taut::detail
