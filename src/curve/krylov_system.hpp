#pragma once

#include <Eigen/Core>

#include "curve/banded_cholesky.hpp"
#include "curve/nodal_curve.hpp"
#include "curve/normal_frame.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// The linear systems of Newton's method (see NewtonKernel) in many dimensions, by preconditioned conjugate gradients
/// on tangent fields: O(d) a node and product, no d x d matrix anywhere.
///
/// Notation: a field s has d entries a node, zero at both ends; P projects each node onto its tangent space.
/// A s = P (K s + mu Hess F s) by one visit of `Evaluator::hessian_times`. K acts on every coordinate alike, so that
/// its inverse G is one banded factorisation for all of them. The preconditioner P G P differs from the inverse of A by
/// a smoothing operator: the eigenvalues of P G A crowd together at 1 (on a sphere they are 1 - (L / (pi i))^2), and
/// the iteration needs as many steps as eigenvalues stand out, whatever d and the mesh.
///
/// Minima are told from saddles by the least eigenvalue of P G A, found by Lanczos' method from a random start (a fixed
/// seed). It sees every eigenvalue with probability 1, and misses one that stands out with a probability that falls
/// exponentially with the steps (Kuczynski, Wozniakowski 1992): a certificate of that kind, no factorisation.
class KrylovSystem {
 public:
  using Frame = NormalFrame;
  using Curve = NodalCurve<Eigen::Dynamic, Eigen::Dynamic>;
  using Nodes = Points;
  static constexpr bool kFactors = false;
  static int high_degree(Index /*q*/) { return 8; }

  KrylovSystem(Index dim, Index codim);

  void resize(const Curve& curve);
  void ask(PointBatch& /*batch*/, Curve& /*curve*/) const {}
  void keep(Index j, const Frame& frame) { normals_.col(j) = frame.normals().reshaped(); }
  [[nodiscard]] double turn(Index i, Index j) const;

  void linearise(Evaluator& evaluator, Curve& curve, Frame& frame);
  /// Solves at once; false where a direction of negative curvature turns up (`definite`) or the iteration breaks down.
  bool factor(const Curve& curve, Evaluator& evaluator, bool curvature, bool definite);
  double solve(Nodes& step) const;

  /// A direction in which the energy falls or hardly changes, where the last `factor` or `confirm_minimum` met one.
  [[nodiscard]] SoftDirection soft_direction(const Curve& curve, Evaluator& evaluator);
  /// That direction, downhill.
  void soft_step(Nodes& step) const;

  /// Looks for a direction in which the energy falls, or hardly changes, that conjugate gradients did not meet, and
  /// whether they went far enough: what they left may be worth more than `energy` where the least eigenvalue is small.
  Confirmation confirm_minimum(const Curve& curve, Evaluator& evaluator, double energy);
  /// After confirm_minimum: no direction of negative curvature, and the search for one was conclusive.
  [[nodiscard]] bool minimum() const { return num_negative_ == 0 && conclusive_; }
  /// Different negative eigenvalues seen: equal ones count once.
  [[nodiscard]] int num_negative() const { return num_negative_; }
  [[nodiscard]] bool resolved() const { return resolved_; }

  void bends(const Curve& curve, Evaluator& evaluator, const Nodes& step, Eigen::VectorXd& result);

 private:
  /// What Lanczos' method found at the lower end of the spectrum of P G A.
  struct Lowest {
    double value = 0;      // least eigenvalue
    int num_negative = 0;  // different ones
    bool conclusive = false;
  };
  /// All fields, or those that vanish at every element end.
  enum class Fields { all, within_elements };

  void project(Nodes& field) const;
  /// out = A field, or P K field.
  void apply(const Curve& curve, Evaluator& evaluator, bool curvature, const Nodes& field, Nodes& out);
  /// out = P G P field; `field` is tangent already.
  void precondition(const BandedCholesky& stiffness, const Nodes& field, Nodes& out) const;
  [[nodiscard]] static double dot(const Nodes& a, const Nodes& b) { return a.cwiseProduct(b).sum(); }
  /// `direction`, when not null, receives the eigenvector.
  Lowest lowest(const Curve& curve, Evaluator& evaluator, Fields fields, Nodes* direction);
  void restrict_fields(const Curve& curve, Fields fields, Nodes& field) const;

  Index d_;
  Index k_;
  Points normals_;  // (d k) x nodes
  Nodes right_, y_, residual_, direction_, product_, scaled_, negative_;
  Eigen::VectorXd scratch_;
  mutable Eigen::VectorXd overlap_;
  BandedCholesky stiffness_;   // K of the inner nodes
  BandedCholesky inside_;      // the same without the element ends
  bool has_negative_ = false;  // negative_ is one
  double left_ = 0;            // r . G r of the last solution
  double least_left_ = 0;      // go on down to this
  int num_negative_ = 0;
  bool conclusive_ = false;
  bool resolved_ = true;
};

}  // namespace taut::detail
