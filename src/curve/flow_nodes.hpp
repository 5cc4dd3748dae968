#pragma once

// Legend, as in the paper's section 4 (index i = node, 0 .. m, the first and last held fixed)
//   p^i          node, a point of R^d on or near the surface
//   eps_i        interval |p^{i+1} - p^i|
//   Delta h      mean of the intervals
//   J, n         Jacobian of F (k x d) and an orthonormal basis of its rows (for k = 1 the normal); P = I - n n^T
//   correction   -J^+ F, the Newton-Raphson step to the surface; for k = 1: -F grad F / |grad F|^2

#include <Eigen/Core>

#include "curve/polyline.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Nodes of a polyline with F, its Jacobian and what follows from them at every node.
class FlowNodes {
 public:
  FlowNodes(Index dim, Index codim) : dim_(dim), codim_(codim) {}

  /// Takes new nodes (d x (m + 1)) and evaluates F there: one visit of the evaluator.
  void evaluate(Evaluator& evaluator, Points points);

  [[nodiscard]] Index size() const { return points_.cols(); }
  [[nodiscard]] Index dim() const { return dim_; }
  [[nodiscard]] Index codim() const { return codim_; }
  [[nodiscard]] const Points& points() const { return points_; }
  [[nodiscard]] const Points& correction() const { return correction_; }  ///< d x (m + 1), -J^+ F
  [[nodiscard]] auto normals(Index i) const {                             ///< d x k, orthonormal columns
    return Eigen::Map<const Eigen::MatrixXd>(normals_.data() + i * dim_ * codim_, dim_, codim_);
  }
  /// grad F_1 .. grad F_k at node i, d x k.
  [[nodiscard]] auto gradients(Index i) const {
    return Eigen::Map<const Eigen::MatrixXd>(jacobian_.data() + i * dim_ * codim_, dim_, codim_);
  }
  /// The lambda (k) with J^T lambda = n n^T v: the multipliers that hold a node on the surface against the pull v.
  void multipliers(Index i, const VectorIn& v, Eigen::Ref<Vector> lambda) const;
  /// Smallest over the nodes of (smallest singular value of J) / (its typical size on the curve), estimated. 0 where J
  /// is not finite. Near 0: the curve runs through a point where J loses rank.
  [[nodiscard]] double rank_margin() const { return rank_margin_; }
  /// Nodes stepped onto the surface: points + correction, the ends unmoved.
  [[nodiscard]] Points corrected() const;

 private:
  Index dim_;
  Index codim_;
  Points points_;
  Points value_;       // k x (m + 1)
  Points jacobian_;    // d k x (m + 1)
  Points normals_;     // d k x (m + 1)
  Points triangle_;    // k k x (m + 1): R of J^T = n R
  Points correction_;  // d x (m + 1)
  double rank_margin_ = 0;
};

/// A polyline and how its nodes are to be spread.
struct FlowCurve {
  Points points;  ///< d x (m + 1)
  Vector widths;  ///< m, > 0: what the intervals are to be in proportion to; all the same = evenly
};

/// How far nodes are from rest: both parts of the tangential C_ss.
struct Repose {
  double geodesic_curvature = 0;  ///< largest discrete |k_g|: across the curve, 1 / model units
  double unevenness = 0;          ///< largest difference of neighbouring eps_i / w_i over their mean: along the curve
};

/// Measures (3) at each inner node with the vector triangle of Figure 2: C_ss is the change of the unit tangent over
/// the mean of the two intervals, its part tangential to the surface and normal to the curve is k_g N. `points` are the
/// nodes to measure, `nodes` gives the normals. `widths`: m.
[[nodiscard]] Repose measure_repose(const FlowNodes& nodes, const PointsIn& points, const VectorIn& widths);

/// How much the tangent space turns along each interval (m): radians for k = 1; for k > 1 the sine of the largest
/// angle, which says the same of small ones.
[[nodiscard]] Vector normal_turns(const FlowNodes& nodes);

}  // namespace taut::detail
