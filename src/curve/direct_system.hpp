#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "curve/conjugate_point.hpp"
#include "curve/element_chain.hpp"
#include "curve/householder_frame.hpp"
#include "curve/nodal_curve.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// The linear systems of Newton's method (see NewtonKernel) in tangent coordinates, factored: for q = d - k up to a
/// few dozen. Blocks T_i^T (K_ij I + delta_ij sum_l mu_l Hess F_l) T_j, elements condensed, Cholesky.
template <int D, int K>
class DirectSystem {
 public:
  using Frame = HouseholderFrame<D, K>;
  using Curve = NodalCurve<D, K>;
  using Nodes = typename Curve::Nodes;
  static constexpr int Q = Frame::Q;
  static constexpr bool kFactors = true;                     ///< pivots tell where conjugate points are
  using Reduced = Eigen::Matrix<double, Q, Eigen::Dynamic>;  ///< tangent coordinates, q a node
  /// Degree of the fine elements where the tolerance asks for a high one.
  static int high_degree(Index q) { return q > 12 ? 4 : 8; }

  DirectSystem(Index dim, Index codim) : d_(dim), k_(codim), q_(dim - codim) {
    hessian_tangents_.resize(d_, q_);
    block_.resize(q_, q_);
    vector_.resize(d_);
  }

  void resize(const Curve& curve) {
    const Index n = curve.num_nodes();
    hessian_.resize(d_ * d_, n);
    tangents_.resize(d_ * q_, n);
    curvature_.resize(q_ * q_, n);
    right_.resize(q_, n);
    y_.resize(q_, n);
    negative_.resize(q_, n);
    chain_.resize(curve.degree(), curve.num_elements(), q_);
    const int p = curve.degree();
    fan_.resize((p + 1) * q_, d_);
    stiffness_.resize((p + 1) * q_, p - 1);
    for (int i = 1; i < p; ++i) {
      for (int j = 0; j <= p; ++j) {
        // The chain's order: inner nodes, then the left end, then the right end.
        const Index slot = j == 0 ? p - 1 : j == p ? p : j - 1;
        stiffness_.col(i - 1).segment(slot * q_, q_).setConstant(curve.element->stiffness(i, j));
      }
    }
  }

  /// What a visit of the evaluator should bring besides F and J. `batch` has room for weights.
  void ask(PointBatch& batch, Curve& curve) {
    if (k_ > 1) return;  // one weight scales the only Hessian: no need to know the multiplier beforehand
    curve.weight.setOnes();
    batch.weight = curve.weight.data();
    batch.hessian = hessian_.data();
  }
  /// Keeps the frame of node j.
  void keep(Index j, const Frame& frame) {
    Eigen::Map<Eigen::Matrix<double, D, Q>>(tangents_.col(j).data(), d_, q_) = frame.tangents();
  }
  /// Tangents at node j, d x q, of the last visit.
  [[nodiscard]] auto tangents(Index j) const {
    return Eigen::Map<const Eigen::Matrix<double, D, Q>>(tangents_.col(j).data(), d_, q_);
  }
  /// How much the tangent space turns from node i to node j (an angle, radians, for small ones).
  [[nodiscard]] double turn(Index i, Index j) const {
    // The sum of the squared sines of the angles between the two spaces.
    const double lost = static_cast<double>(q_) - (tangents(j).transpose() * tangents(i)).squaredNorm();
    return std::asin(std::sqrt(std::clamp(lost, 0.0, 1.0)));
  }

  /// Multipliers, reduced gradient and reduced curvature at every inner node. `frame` is scratch.
  void linearise(Evaluator& evaluator, Curve& curve, Frame& frame) {
    const Index n = curve.num_nodes();
    for (Index j = 1; j + 1 < n; ++j) {
      const auto gradients = curve.gradients(j);
      // k = 1: the Hessian has come with the visit, with weight 1; mu scales it below. k > 1: a visit with the weights
      // mu.
      if (k_ == 1) {
        curve.weight(0, j) = -gradients.col(0).dot(curve.force.col(j)) / gradients.col(0).squaredNorm();
      } else {
        frame.compute(gradients);
        frame.multipliers(curve.force.col(j), curve.weight.col(j));
      }
    }
    // The ends are fixed: no multiplier.
    if (k_ > 1) {
      curve.weight.col(0).setZero();
      curve.weight.col(n - 1).setZero();
      evaluator.evaluate({.n = n, .x = curve.x.data(), .weight = curve.weight.data(), .hessian = hessian_.data()});
    }
    for (Index j = 1; j + 1 < n; ++j) {
      Eigen::Map<const Eigen::Matrix<double, D, D>> hessian(hessian_.col(j).data(), d_, d_);
      const auto t = tangents(j);
      const double mu = k_ == 1 ? curve.weight(0, j) : 1.0;
      hessian_tangents_.noalias() = hessian * t;
      block_.noalias() = mu * (t.transpose() * hessian_tangents_);
      Eigen::Map<Eigen::Matrix<double, Q, Q>>(curvature_.col(j).data(), q_, q_) = block_;
      right_.col(j).noalias() =
          -(t.transpose() * curve.force.col(j)) - mu * (hessian_tangents_.transpose() * curve.off.col(j));
    }
    right_.col(0).setZero();
    right_.col(n - 1).setZero();
  }

  /// Readies `solve`. Without `curvature` the Hessian is dropped. With `definite`, false where the matrix is not
  /// positive definite; without, only where it is singular.
  bool factor(const Curve& curve, Evaluator& /*evaluator*/, bool curvature, bool definite) {
    const bool assembled = assemble(curve, curvature, false);
    // Without the curvature every element is positive definite, which says nothing about the mesh.
    if (curvature) resolved_ = chain_.condensed();
    return assembled && chain_.factor(definite);
  }
  /// The step, d x nodes, zero at the ends. Returns its slope: minus step . A step.
  double solve(Nodes& step) {
    chain_.solve(y_.data());
    expand(y_, step);
    return -right_.cwiseProduct(y_).sum();
  }

  /// After factor(curve, true, true) failed: a direction in which the energy does not rise; after confirm_minimum the
  /// softest. It is nearly neutral where a conjugate point is close to the end (as between antipodes of a sphere). None
  /// where the energy falls within an element already: the pivots say nothing then.
  SoftDirection soft_direction(const Curve& curve, Evaluator& /*evaluator*/) {
    // An element alone already has a negative direction: the pivots of the ends were never made.
    if (!chain_.condensed()) return {};
    // Fields that vanish from the next element end on: the least curvature shows where the pivot fails, or at the last
    // one.
    const Index end = chain_.first_failing() < 0 ? curve.num_elements() - 1 : chain_.first_failing();
    if (end <= 0) return {};
    SoftDirection soft;
    soft.found = true;
    constexpr double kAlike = 1e-3;  // of the stiffness of an element
    soft.curvature = chain_.soft_direction(end, kAlike * curve.scale(end) / 2, negative_.data());
    soft.slope = std::abs(right_.cwiseProduct(negative_).sum());
    soft.longest = std::sqrt(negative_.colwise().squaredNorm().maxCoeff());
    soft.stiffness = 0;
    const int p = curve.degree();
    const Index n = curve.num_nodes();
    for (Index e = 0; e < curve.num_elements(); ++e) {
      for (int i = 0; i <= p; ++i) {
        vector_.setZero();
        for (int j = 0; j <= p; ++j) {
          const Index node = e * p + j;
          if (node > 0 && node + 1 < n) {
            vector_.noalias() += curve.element->stiffness(j, i) * (tangents(node) * negative_.col(node));
          }
        }
        const Index node = e * p + i;
        if (node > 0 && node + 1 < n) {
          soft.stiffness += curve.scale(e) * vector_.dot(tangents(node) * negative_.col(node));
        }
      }
    }
    return soft;
  }
  /// That direction, downhill, d x nodes.
  void soft_step(Nodes& step) {
    if (right_.cwiseProduct(negative_).sum() < 0) negative_ = -negative_;
    expand(negative_, step);
  }

  /// After factor(curve, true, true): the factorisation has told already, but for how small the least curvature may be.
  [[nodiscard]] Confirmation confirm_minimum(const Curve& curve, Evaluator& /*evaluator*/, double /*energy*/) {
    // The last pivot alone: it tells of the whole curve, once those before are positive definite.
    constexpr double kWeak = 0.05;  // of the stiffness of an element
    const Index last = curve.num_elements() - 1;
    if (last < 1) return Confirmation::minimum;
    const double stiffness = (curve.scale(last - 1) + curve.scale(last)) / 2;
    return chain_.least_pivot(last) < kWeak * stiffness ? Confirmation::soft : Confirmation::minimum;
  }
  /// Was the last factored matrix positive definite.
  [[nodiscard]] bool minimum() const { return chain_.condensed() && chain_.first_failing() < 0; }
  [[nodiscard]] int num_negative() const { return chain_.num_negative(); }
  /// Is every element alone positive definite: fine enough a mesh to tell minima by the pivots.
  [[nodiscard]] bool resolved() const { return resolved_; }

  /// |step_j . Hess F step_j| at every node, k = 1.
  void bends(const Curve& curve, Evaluator& /*evaluator*/, const Nodes& step, Eigen::VectorXd& result) const {
    for (Index j = 1; j + 1 < curve.num_nodes(); ++j) {
      Eigen::Map<const Eigen::Matrix<double, D, D>> hessian(hessian_.col(j).data(), d_, d_);
      result(j) = std::abs(step.col(j).dot(hessian * step.col(j)));
    }
  }

  /// Parameter of the first conjugate point after factor(curve, true, false) counted negative directions.
  std::optional<double> conjugate_point(const Curve& curve, bool regular_ends) {
    const Index failing = chain_.first_failing();
    if (failing < 0 || !regular_ends) return std::nullopt;
    // Factored again with free ends: the couplings that Jacobi fields start from were left out.
    chain_.start();
    if (!assemble(curve, true, true)) return std::nullopt;
    return find_conjugate_point(curve, *this, failing);
  }
  [[nodiscard]] ElementChain<Q>& chain() { return chain_; }

 private:
  // step = T y.
  void expand(const Reduced& y, Nodes& step) const {
    const Index n = y.cols();
    for (Index j = 1; j + 1 < n; ++j) step.col(j).noalias() = tangents(j) * y.col(j);
    step.col(0).setZero();
    step.col(n - 1).setZero();
  }

  // Fills the chain and condenses its elements. `ends_free` keeps the couplings to the fixed ends of the curve: what
  // Jacobi fields are made of.
  bool assemble(const Curve& curve, bool curvature, bool ends_free) {
    const int p = curve.degree();
    const Index m = curve.num_elements();
    const Index inner = chain_.inner();
    chain_.start();
    for (Index e = 0; e < m; ++e) {
      const double scale = curve.scale(e);
      const Index first = e * p;
      for (int j = 0; j <= p; ++j) {
        // Zero tangents of a fixed end make its coupling zero.
        const bool fixed = !ends_free && ((j == 0 && e == 0) || (j == p && e + 1 == m));
        const Index slot = j == 0 ? inner : j == p ? inner + q_ : (j - 1) * q_;
        if (fixed) {
          fan_.middleRows(slot, q_).setZero();
        } else {
          fan_.middleRows(slot, q_) = tangents(first + j).transpose();
        }
      }
      for (int i = 1; i < p; ++i) {
        const Index slot = (i - 1) * q_;
        const Index columns = inner + 2 * q_ - slot;
        const auto ti = tangents(first + i);
        for (Index a = 0; a < q_; ++a) {
          // Row a of all blocks T_i^T K_ij T_j, j from i on, in one product: symmetric, so that the rest is not needed.
          double* row = chain_.row(e, slot + a);
          Eigen::Map<Eigen::VectorXd>(row + slot, columns).noalias() =
              scale * stiffness_.col(i - 1).tail(columns).cwiseProduct(fan_.bottomRows(columns).lazyProduct(ti.col(a)));
          if (curvature) {
            for (Index b = 0; b < q_; ++b) row[slot + b] += curvature_block(first + i)(a, b);
          }
          row[chain_.width() - 1] = right_(a, first + i);
        }
      }
      auto ends = chain_.end_block(e);
      auto right = chain_.end_right(e);
      ends.setZero();
      right.setZero();
      // T^T T = I, and K_00 = K_pp by symmetry of the nodes.
      ends.diagonal().setConstant(scale * curve.element->stiffness(0, 0));
      if (e > 0) {  // the node shared with the element before is booked here
        right.head(q_) = right_.col(first);
        if (curvature) ends.topLeftCorner(q_, q_) += curvature_block(first);
      }
      if (ends_free || (e > 0 && e + 1 < m)) {
        block_.noalias() = tangents(first).transpose() * tangents(first + p);
        block_ *= scale * curve.element->stiffness(0, p);
        ends.topRightCorner(q_, q_) = block_;
        ends.bottomLeftCorner(q_, q_) = block_.transpose();
      }
      if (!chain_.condense(e)) return false;
    }
    return true;
  }
  [[nodiscard]] auto curvature_block(Index j) const {
    return Eigen::Map<const Eigen::Matrix<double, Q, Q>>(curvature_.col(j).data(), q_, q_);
  }

  Index d_;
  Index k_;
  Index q_;
  Eigen::MatrixXd hessian_, tangents_, curvature_;
  Reduced right_, y_, negative_;
  // Of one element, in the chain's order of unknowns (inner nodes, left end, right end): tangents, and for every inner
  // node its row of the stiffness matrix, each entry q times.
  Eigen::Matrix<double, Eigen::Dynamic, D> fan_;
  Eigen::MatrixXd stiffness_;
  ElementChain<Q> chain_;
  Eigen::Matrix<double, D, Q> hessian_tangents_;
  Eigen::Matrix<double, Q, Q> block_;
  Eigen::Matrix<double, D, 1> vector_;
  bool resolved_ = false;
};

}  // namespace taut::detail
