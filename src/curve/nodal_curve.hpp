#pragma once

#include <Eigen/Core>
#include <vector>

#include "curve/reference_element.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// A field v along a curve in which its energy falls or hardly changes: what a system found out about it.
struct SoftDirection {
  bool found = false;
  double slope = 0;      ///< |dE v|, at least 0
  double curvature = 0;  ///< v^T A v
  double stiffness = 1;  ///< v^T K v
  double longest = 0;    ///< max |v|
  [[nodiscard]] double relative() const { return curvature / stiffness; }
};

/// What a second look at a matrix found that had no failing pivot.
enum class Confirmation {
  minimum,
  soft,        ///< there is a direction in which the energy falls, or hardly changes
  too_coarse,  ///< the last solution is not exact enough to tell: factor again
};

/// A curve on a mesh of elements in a row, and what the last visit found at its nodes: what the parts of Newton's
/// method share. D and K are the sizes d and k at compile time, or Eigen::Dynamic.
template <int D, int K>
struct NodalCurve {
  using Nodes = Eigen::Matrix<double, D, Eigen::Dynamic>;
  using VectorD = Eigen::Matrix<double, D, 1>;

  Index dim = 0;
  Index codim = 0;
  const ReferenceElement* element = nullptr;
  std::vector<double> lengths;  ///< h_e, of m elements

  Nodes x;                                          ///< d x (m p + 1): the nodes
  Eigen::Matrix<double, K, Eigen::Dynamic> value;   ///< F
  Eigen::MatrixXd jacobian;                         ///< (d k) x nodes, laid out as in PointBatch
  Eigen::Matrix<double, K, Eigen::Dynamic> weight;  ///< mu
  Nodes off;                                        ///< n = -J^+ F; nothing at the ends
  Nodes normal;                                     ///< a unit normal (the first of k); nothing at a singular end
  Nodes force;                                      ///< K (x + n)

  void set_mesh(int degree, const std::vector<double>& element_lengths) {
    element = &ReferenceElement::of_degree(degree);
    lengths = element_lengths;
    const Index n = num_nodes();
    for (Nodes* field : {&x, &off, &normal, &force}) field->resize(dim, n);
    value.resize(codim, n);
    weight.resize(codim, n);
    jacobian.resize(dim * codim, n);
  }
  [[nodiscard]] int degree() const { return element->degree; }
  [[nodiscard]] Index num_elements() const { return static_cast<Index>(lengths.size()); }
  [[nodiscard]] Index num_nodes() const { return num_elements() * degree() + 1; }
  /// grad F_1 .. grad F_k at node j, d x k.
  [[nodiscard]] auto gradients(Index j) const {
    return Eigen::Map<const Eigen::Matrix<double, D, K>>(jacobian.col(j).data(), dim, codim);
  }
  [[nodiscard]] double scale(Index e) const { return 2 / lengths[static_cast<std::size_t>(e)]; }

  /// out = K field, both d x nodes. Returns field . K field. `scratch` has d entries.
  double apply_stiffness(const Nodes& field, Nodes& out, VectorD& scratch) const {
    const int p = degree();
    out.setZero();
    double total = 0;
    for (Index e = 0; e < num_elements(); ++e) {
      const Index first = e * p;
      double sum = 0;
      for (int i = 0; i <= p; ++i) {
        scratch.setZero();
        for (int j = 0; j <= p; ++j) {  // rows of K sum to zero: differences keep the digits
          scratch += element->stiffness(j, i) * (field.col(first + j) - field.col(first));
        }
        scratch *= scale(e);
        out.col(first + i) += scratch;
        // The same freedom again: adding a constant to the field changes nothing.
        sum += scratch.dot(field.col(first + i) - field.col(first));
      }
      total += sum;
    }
    return total;
  }
};

}  // namespace taut::detail
