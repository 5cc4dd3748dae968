#pragma once

#include <Eigen/Core>

namespace taut::detail {

/// The tables of one polynomial degree p on [-1, 1], computed once (in extended precision) and immutable.
/// Nodes are Gauss-Lobatto-Legendre; a polynomial is its p + 1 nodal values. Check points are the p + 2 Gauss points,
/// which lie strictly between nodes: there a curve shows what its nodes hide.
struct ReferenceElement {
  static constexpr int kMaxDegree = 16;

  int degree = 0;
  Eigen::VectorXd node;         ///< p + 1, ascending from -1 to 1
  Eigen::VectorXd weight;       ///< p + 1, Lobatto quadrature, exact to degree 2 p - 1
  Eigen::MatrixXd derivative;   ///< (p + 1) x (p + 1): row i gives u'(node_i)
  Eigen::MatrixXd stiffness;    ///< (p + 1) x (p + 1): int l_i' l_j', exact
  Eigen::VectorXd barycentric;  ///< p + 1

  Eigen::VectorXd check_node;    ///< p + 2
  Eigen::VectorXd check_weight;  ///< p + 2, Gauss quadrature, exact to degree 2 p + 3
  Eigen::MatrixXd check_value;   ///< (p + 1) x (p + 2): column g holds l_i(check_node_g)
  Eigen::MatrixXd check_first;   ///< the same for l_i'
  Eigen::MatrixXd check_second;  ///< the same for l_i''

  /// (p + 2) x 4, p >= 5: samples of u'' at the check nodes, times column c, give its Legendre coefficient of degree
  /// p - 5 + c.
  Eigen::MatrixXd check_modes;

  [[nodiscard]] int num_nodes() const { return degree + 1; }
  [[nodiscard]] int num_checks() const { return degree + 2; }

  /// l_i(xi) for all i (p + 1 of them).
  void basis(double xi, Eigen::Ref<Eigen::VectorXd> values) const;

  /// 1 <= degree <= kMaxDegree.
  [[nodiscard]] static const ReferenceElement& of_degree(int degree);
};

}  // namespace taut::detail
