#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "curve/element_chain.hpp"
#include "curve/reference_element.hpp"
#include "curve/tangent_frame.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// How Newton's iteration on one mesh ended.
enum class Relaxation {
  converged,
  saddle,       ///< a geodesic, but not a minimum: energy falls along a direction of negative curvature
  stalled,      ///< no step decreases the energy any more, or the iterations are used up
  singular,     ///< the Jacobian lost rank, or F is not finite, at a node
  off_surface,  ///< the start does not project onto the surface
  collapsed,    ///< the curve shrank to a point
};

/// What one relaxation is asked for.
struct RelaxationGoal {
  double energy = 1e-12;       ///< stop when the next step would lower the energy by less than this fraction of it
  double off_surface = 1e-12;  ///< ... and nodes are at most this far off the surface, model units
  int max_iterations = 100;
  bool minimum = true;  ///< accept only a local minimum; else the nearest geodesic, by steps of either kind
};

/// Newton's method for a geodesic on one mesh.
///
/// Notation: curve x(t), 0 <= t <= T, on elements [t_e, t_{e+1}] of length h_e, polynomial of degree p on
/// Gauss-Lobatto-Legendre nodes x_j in R^d; ends fixed. E = 1/2 int |x'|^2 dt = 1/2 sum_ij K_ij x_i . x_j exactly,
/// under F(x_j) = 0. J is the k x d Jacobian at a node, T its d x q tangents, n = -J^+ F the step to the linearised
/// surface. Stationary: K x + J^T mu = 0. One step: x_j <- x_j + n_j + T_j y_j with
///   A_ij = T_i^T (K_ij I + delta_ij sum_l mu_l Hess F_l) T_j,   A y = -T^T (K (x + n) + mu Hess F n),
/// which is Newton's method for the constrained problem written in tangent coordinates. When A is not positive definite
/// the curvature term is dropped: then T^T K T is the metric of a Sobolev gradient, and the step shortens the curve.
/// The energy of x + n decides about a step's length.
template <int D, int K>
class NewtonKernel {
 public:
  static constexpr int Q = TangentFrame<D, K>::Q;
  using VectorD = Eigen::Matrix<double, D, 1>;
  using VectorK = Eigen::Matrix<double, K, 1>;
  using VectorQ = Eigen::Matrix<double, Q, 1>;
  using Nodes = Eigen::Matrix<double, D, Eigen::Dynamic>;
  using Reduced = Eigen::Matrix<double, Q, Eigen::Dynamic>;  ///< tangent coordinates, q a node

  NewtonKernel(Index dim, Index codim) : d_(dim), k_(codim), q_(dim - codim) {
    frame_.resize(d_, k_);
    mu_scratch_.resize(k_);
    hessian_tangents_.resize(d_, q_);
    curvature_block_.resize(q_, q_);
    vector_.resize(d_);
  }

  // The mesh and the curve on it.

  /// Sets degree and element lengths; nodes are to be filled in by `node`.
  void set_mesh(int degree, const std::vector<double>& lengths) {
    element_ = &ReferenceElement::of_degree(degree);
    lengths_ = lengths;
    period_ = 0;
    for (const double h : lengths_) period_ += h;
    const Index n = num_nodes();
    x_.resize(d_, n);
    base_.resize(d_, n);
    step_.resize(d_, n);
    force_.resize(d_, n);
    normal_.resize(d_, n);
    old_normal_.resize(d_, n);
    value_.resize(k_, n);
    jacobian_.resize(d_ * k_, n);
    weight_.resize(k_, n);
    hessian_.resize(d_ * d_, n);
    tangents_.resize(d_ * q_, n);
    curvature_.resize(q_ * q_, n);
    right_.resize(q_, n);
    y_.resize(q_, n);
    negative_.resize(q_, n);
    chain_.resize(degree, num_elements(), q_);
  }
  [[nodiscard]] int degree() const { return element_->degree; }
  [[nodiscard]] const ReferenceElement& element() const { return *element_; }
  [[nodiscard]] Index num_elements() const { return static_cast<Index>(lengths_.size()); }
  [[nodiscard]] Index num_nodes() const { return num_elements() * degree() + 1; }
  [[nodiscard]] const std::vector<double>& lengths() const { return lengths_; }
  [[nodiscard]] double period() const { return period_; }  ///< T
  [[nodiscard]] Nodes& nodes() { return x_; }
  [[nodiscard]] ElementChain<Q>& chain() { return chain_; }
  /// Tangents at inner node j, d x q, of the last visit.
  [[nodiscard]] auto tangents(Index j) const {
    return Eigen::Map<const Eigen::Matrix<double, D, Q>>(tangents_.col(j).data(), d_, q_);
  }

  /// A unit normal at node j (the first of k), of the last visit.
  [[nodiscard]] auto normal(Index j) const { return normal_.col(j); }
  [[nodiscard]] Index codim() const { return k_; }

  [[nodiscard]] double energy() const { return energy_; }
  [[nodiscard]] double length() const { return std::sqrt(2 * energy_ * period_); }
  [[nodiscard]] double decrement() const { return decrement_; }      ///< energy the last step was predicted to gain
  [[nodiscard]] double off_surface() const { return off_surface_; }  ///< max |n| at the last visit
  [[nodiscard]] int num_iterations() const { return iterations_; }
  [[nodiscard]] Index num_evaluated() const { return evaluated_; }
  /// Did the last relaxation end with a full Newton step: then what is left is of second order in decrement().
  [[nodiscard]] bool settled() const { return settled_; }
  void reset_counters() {
    iterations_ = 0;
    evaluated_ = 0;
  }

  /// Is every element alone positive definite: fine enough a mesh to tell minima by the pivots.
  [[nodiscard]] bool resolved() const { return resolved_; }
  /// How far the ends are off the surface, model units.
  [[nodiscard]] double ends_off() const { return ends_off_; }
  [[nodiscard]] bool regular_ends() const { return regular_ends_; }
  /// Fills and condenses the chain as it was at the last step, couplings to the ends of the curve included: what Jacobi
  /// fields are made of.
  bool condense_with_ends() {
    chain_.start();
    return assemble(true, true);
  }

  /// Moves the nodes to a geodesic.
  Relaxation relax(Evaluator& evaluator, const RelaxationGoal& goal, const Context& context) {
    Relaxation outcome = project(evaluator);
    if (outcome != Relaxation::converged) return outcome;
    const double start_energy = energy_;
    double push = 0.03;
    for (int count = 0; count < goal.max_iterations; ++count) {
      context.check_cancelled();
      ++iterations_;
      settled_ = false;
      if (energy_ <= 1e-22 * start_energy || energy_ == 0) return Relaxation::collapsed;
      linearise();
      definite_ = assemble_and_factor(true, true);
      resolved_ = chain_.condensed();
      bool descend = true;  // towards a minimum: the energy has to fall
      bool negative = false;
      if (!definite_) {
        negative = chain_.first_failing() > 0 && find_negative_direction();
        descend = goal.minimum || chain_.first_failing() < 0 || !assemble_and_factor(true, false);
        if (descend && !assemble_and_factor(false, true)) return Relaxation::stalled;
      }
      chain_.solve(y_.data());
      const double slope = -right_.cwiseProduct(y_).sum();
      decrement_ = 0.5 * std::abs(slope);
      const bool flat = decrement_ <= std::max(goal.energy, 4e-16) * energy_;
      if (negative && goal.minimum && decrement_ <= 1e-3 * energy_) {
        if (leave_saddle(evaluator, slope, push)) continue;
        if (flat) return Relaxation::saddle;
      }
      form_step(y_);
      if (flat) {
        // Along a nearly neutral direction (conjugate ends) even a worthless step is long: then only go to the surface.
        const double longest = step_.colwise().norm().maxCoeff();
        if (off_surface_ <= goal.off_surface) {
          x_ = base_;
          settled_ = (definite_ || !descend) && longest * longest <= goal.off_surface * period_;
          if (settled_) x_ += step_;
          return Relaxation::converged;
        }
        if (decrement_ <= 1e-2 * goal.energy * energy_) {
          x_ = base_;
          visit(evaluator);
          if (!measure()) return Relaxation::singular;
          continue;
        }
      }
      if (search(evaluator, slope, !descend)) continue;
      if (flat) return Relaxation::converged;
      // Close to a conjugate point a Newton step can be too long to be of use; shortening still is.
      if (!definite_ || !descend || !shorten(evaluator, goal)) return failure_;
    }
    return Relaxation::stalled;
  }

 private:
  static constexpr double kMostTurn = 0.7;  // radians a node may move around its surface in one step

  // F, J (and second derivatives) at the nodes.
  void visit(Evaluator& evaluator) {
    const Index n = num_nodes();
    evaluated_ += n;
    PointBatch batch{.n = n, .x = x_.data(), .value = value_.data(), .jacobian = jacobian_.data()};
    if (k_ == 1) {  // one weight scales the only Hessian: no need to know the multiplier beforehand
      weight_.setOnes();
      batch.weight = weight_.data();
      batch.hessian = hessian_.data();
    }
    evaluator.evaluate(batch);
    evaluator_ = &evaluator;
  }

  // Frames, normal corrections, the corrected nodes `base_`, their force and energy. False where J loses rank.
  bool measure() {
    const Index n = num_nodes();
    off_surface_ = 0;
    base_ = x_;
    for (Index j = 0; j < n; ++j) {
      Eigen::Map<const Eigen::Matrix<double, D, K>> gradients(jacobian_.col(j).data(), d_, k_);
      const bool regular = value_.col(j).allFinite() && frame_.compute(gradients);
      if (j == 0 || j + 1 == n) {  // an end may be a singular point: it does not move
        if (j == 0) ends_off_ = 0;
        if (regular) {
          frame_.pseudo_inverse(value_.col(j), mu_scratch_, vector_);
          ends_off_ = std::max(ends_off_, vector_.norm());
        }
        regular_ends_ = (j == 0 || regular_ends_) && regular;
        if (regular) Eigen::Map<Eigen::Matrix<double, D, Q>>(tangents_.col(j).data(), d_, q_) = frame_.tangents();
        continue;
      }
      if (!regular) return false;
      frame_.pseudo_inverse(-value_.col(j), mu_scratch_, vector_);
      normal_.col(j) = frame_.first_normal();
      Eigen::Map<Eigen::Matrix<double, D, Q>>(tangents_.col(j).data(), d_, q_) = frame_.tangents();
      step_.col(j) = vector_;  // kept until linearise(): n
      base_.col(j) += vector_;
      off_surface_ = std::max(off_surface_, vector_.norm());
    }
    apply_stiffness();
    return std::isfinite(energy_);
  }

  // force_ = K base_, energy_ = E(base_).
  void apply_stiffness() {
    const int p = degree();
    force_.setZero();
    double energy = 0;
    for (Index e = 0; e < num_elements(); ++e) {
      const double scale = 2 / lengths_[static_cast<std::size_t>(e)];
      const Index first = e * p;
      double sum = 0;
      for (int i = 0; i <= p; ++i) {
        vector_.setZero();
        for (int j = 0; j <= p; ++j) {  // rows of K sum to zero: differences keep the digits
          vector_ += element_->stiffness(j, i) * (base_.col(first + j) - base_.col(first));
        }
        vector_ *= scale;
        force_.col(first + i) += vector_;
        sum += vector_.dot(base_.col(first + i) - base_.col(first));
      }
      energy += sum;
    }
    energy_ = energy / 2;
  }

  Relaxation project(Evaluator& evaluator) {
    for (int round = 0; round < 50; ++round) {
      visit(evaluator);
      if (!measure()) return Relaxation::singular;
      double worst = 0;
      for (Index j = 1; j + 1 < num_nodes(); ++j) {
        const auto e = static_cast<std::size_t>(std::min(j / degree(), num_elements() - 1));
        const double near =
            std::max((x_.col(j + 1) - x_.col(j - 1)).norm() / 2, lengths_[e] / (2 * static_cast<double>(degree())));
        const double share = step_.col(j).norm() / near;
        worst = std::max(worst, share);
        // where F is far from linear (inside a thin body) a full step would fly away
        if (share > 0.5) base_.col(j) = x_.col(j) + (0.5 / share) * step_.col(j);
      }
      if (worst <= 0.05) return Relaxation::converged;
      x_ = base_;
    }
    return Relaxation::off_surface;
  }

  // Multipliers, reduced gradient and reduced curvature at every inner node.
  void linearise() {
    const Index n = num_nodes();
    for (Index j = 1; j + 1 < n; ++j) {
      Eigen::Map<const Eigen::Matrix<double, D, K>> gradients(jacobian_.col(j).data(), d_, k_);
      if (k_ == 1) {
        weight_(0, j) = -gradients.col(0).dot(force_.col(j)) / gradients.col(0).squaredNorm();
      } else {
        frame_.compute(gradients);
        frame_.multipliers(force_.col(j), weight_.col(j));
      }
    }
    if (k_ > 1) {
      weight_.col(0).setZero();
      weight_.col(n - 1).setZero();
      evaluator_->evaluate({.n = n, .x = x_.data(), .weight = weight_.data(), .hessian = hessian_.data()});
    }
    for (Index j = 1; j + 1 < n; ++j) {
      Eigen::Map<const Eigen::Matrix<double, D, D>> hessian(hessian_.col(j).data(), d_, d_);
      const auto t = tangents(j);
      const double mu = k_ == 1 ? weight_(0, j) : 1.0;
      hessian_tangents_.noalias() = hessian * t;
      curvature_block_.noalias() = mu * (t.transpose() * hessian_tangents_);
      Eigen::Map<Eigen::Matrix<double, Q, Q>>(curvature_.col(j).data(), q_, q_) = curvature_block_;
      right_.col(j).noalias() = -(t.transpose() * force_.col(j)) - mu * (hessian_tangents_.transpose() * step_.col(j));
    }
    right_.col(0).setZero();
    right_.col(n - 1).setZero();
  }

  bool assemble_and_factor(bool curvature, bool definite) {
    return assemble(curvature, false) && chain_.factor(definite);
  }

  // Fills the chain and condenses its elements. `ends_free` keeps the couplings to the fixed ends of the curve.
  bool assemble(bool curvature, bool ends_free) {
    const int p = degree();
    const Index inner = chain_.inner();
    chain_.start();
    for (Index e = 0; e < num_elements(); ++e) {
      const double scale = 2 / lengths_[static_cast<std::size_t>(e)];
      const Index first = e * p;
      for (int i = 1; i < p; ++i) {
        const auto ti = tangents(first + i);
        for (Index a = 0; a < q_; ++a) chain_.row(e, (i - 1) * q_ + a)[chain_.width() - 1] = right_(a, first + i);
        for (int j = 0; j <= p; ++j) {
          if (j > 0 && j < i) continue;
          const bool boundary = !ends_free && ((j == 0 && e == 0) || (j == p && e + 1 == num_elements()));
          const Index column = j == 0 ? inner : j == p ? inner + q_ : (j - 1) * q_;
          const double stiffness = scale * element_->stiffness(i, j);
          if (boundary) {
            curvature_block_.setZero();
          } else if (j == i) {
            curvature_block_.setIdentity();
            curvature_block_ *= stiffness;
            if (curvature) {
              curvature_block_ +=
                  Eigen::Map<const Eigen::Matrix<double, Q, Q>>(curvature_.col(first + i).data(), q_, q_);
            }
          } else {
            curvature_block_.noalias() = ti.transpose() * tangents(first + j);
            curvature_block_ *= stiffness;
          }
          for (Index a = 0; a < q_; ++a) {
            double* row = chain_.row(e, (i - 1) * q_ + a) + column;
            for (Index b = 0; b < q_; ++b) row[b] = curvature_block_(a, b);
          }
        }
      }
      auto ends = chain_.end_block(e);
      auto right = chain_.end_right(e);
      ends.setZero();
      right.setZero();
      ends.diagonal().setConstant(scale * element_->stiffness(0, 0));
      if (e > 0) {  // the node shared with the element before is booked here
        right.head(q_) = right_.col(first);
        if (curvature) {
          ends.topLeftCorner(q_, q_) +=
              Eigen::Map<const Eigen::Matrix<double, Q, Q>>(curvature_.col(first).data(), q_, q_);
        }
      }
      if (ends_free || (e > 0 && e + 1 < num_elements())) {
        curvature_block_.noalias() = tangents(first).transpose() * tangents(first + p);
        curvature_block_ *= scale * element_->stiffness(0, p);
        ends.topRightCorner(q_, q_) = curvature_block_;
        ends.bottomLeftCorner(q_, q_) = curvature_block_.transpose();
      }
      if (!chain_.condense(e)) return false;
    }
    return true;
  }

  // One Sobolev step from where the last search began. False when that, too, leads nowhere.
  bool shorten(Evaluator& evaluator, const RelaxationGoal& goal) {
    x_ = trial_base_;
    visit(evaluator);
    if (!measure()) return false;
    linearise();
    if (!assemble_and_factor(false, true)) return false;
    chain_.solve(y_.data());
    const double slope = -right_.cwiseProduct(y_).sum();
    decrement_ = 0.5 * std::abs(slope);
    form_step(y_);
    if (search(evaluator, slope, false)) return true;
    if (decrement_ <= std::max(goal.energy, 4e-16) * trial_energy_) failure_ = Relaxation::converged;
    return false;
  }

  // step_ = T y.
  void form_step(const Reduced& y) {
    for (Index j = 1; j + 1 < num_nodes(); ++j) step_.col(j).noalias() = tangents(j) * y.col(j);
    step_.col(0).setZero();
    step_.col(num_nodes() - 1).setZero();
  }

  // x_ = base_ + alpha step_, halving alpha until the energy falls enough and no node has left its sheet. `free`
  // accepts any energy (a step towards a saddle).
  bool search(Evaluator& evaluator, double slope, bool free) {
    const double energy = energy_;
    trial_energy_ = energy_;
    const double off = off_surface_;
    trial_base_ = base_;
    trial_step_ = step_;
    old_normal_ = normal_;
    const double longest = trial_step_.colwise().norm().maxCoeff();
    double alpha = std::min({1.0, 0.25 * length() / std::max(longest, 1e-300), largest_step()});
    failure_ = Relaxation::stalled;
    for (int halving = 0; halving < 30; ++halving, alpha /= 2) {
      x_ = trial_base_ + alpha * trial_step_;
      visit(evaluator);
      if (!measure()) {
        failure_ = Relaxation::singular;
        continue;
      }
      failure_ = Relaxation::stalled;
      if (!same_sheet(alpha, off)) continue;
      if (free || energy_ <= energy + 1e-4 * alpha * slope + 1e-14 * energy) return true;
    }
    return false;
  }

  // The share of step_ over which the surface turns by at most kMostTurn under every node (k = 1; for more equations
  // only same_sheet() watches).
  [[nodiscard]] double largest_step() const {
    double share = 1;
    if (k_ > 1) return share;
    for (Index j = 1; j + 1 < num_nodes(); ++j) {
      Eigen::Map<const Eigen::Matrix<double, D, D>> hessian(hessian_.col(j).data(), d_, d_);
      const double bend = std::abs(step_.col(j).dot(hessian * step_.col(j)));
      const double reach = kMostTurn * jacobian_.col(j).norm() * step_.col(j).norm();
      if (bend * share > reach) share = reach / bend;
    }
    return share;
  }

  // A step s along the tangent plane leaves the surface by about s^2 / (2 radius). One that leaves it by much more, or
  // meets a turned normal, has lost the sheet it started on.
  [[nodiscard]] bool same_sheet(double alpha, double off) const {
    for (Index j = 1; j + 1 < num_nodes(); ++j) {
      const double moved = alpha * trial_step_.col(j).norm();
      if (step_.col(j).norm() > 0.3 * moved + 2 * off + 1e-12 * period_) return false;
      if (k_ > 1) continue;
      if (normal_.col(j).dot(old_normal_.col(j)) < 0.3) return false;
      // Neighbours that drift apart around the surface would let the curve slip through it.
      if (j > 1 && normal_.col(j).dot(normal_.col(j - 1)) < 0.2 &&
          old_normal_.col(j).dot(old_normal_.col(j - 1)) >= 0.2) {
        return false;
      }
    }
    return true;
  }

  // After a failed factorisation. False when the direction is neutral (a conjugate point at the very end, as between
  // antipodes of a sphere): then there is nothing to gain along it.
  bool find_negative_direction() {
    const double curvature = chain_.negative_direction(negative_.data());
    double stiffness = 0;
    const int p = degree();
    for (Index e = 0; e < num_elements(); ++e) {
      const double scale = 2 / lengths_[static_cast<std::size_t>(e)];
      for (int i = 0; i <= p; ++i) {
        vector_.setZero();
        for (int j = 0; j <= p; ++j) {
          const Index node = e * p + j;
          if (node > 0 && node + 1 < num_nodes()) {
            vector_.noalias() += element_->stiffness(j, i) * (tangents(node) * negative_.col(node));
          }
        }
        const Index node = e * p + i;
        if (node > 0 && node + 1 < num_nodes()) {
          stiffness += scale * vector_.dot(tangents(node) * negative_.col(node));
        }
      }
    }
    return curvature < -1e-7 * stiffness;
  }

  // Goes down along the negative direction, by steps that grow while they succeed.
  bool leave_saddle(Evaluator& evaluator, double slope, double& push) {
    if (right_.cwiseProduct(negative_).sum() < 0) negative_ = -negative_;
    form_step(negative_);
    const double longest = step_.colwise().norm().maxCoeff();
    if (!(longest > 0)) return false;
    step_ *= push * length() / longest;
    const double before = energy_;
    if (!search(evaluator, 0, false)) return false;
    push = std::min(0.2, 2 * push);
    return energy_ < before - 1e-13 * before || slope < -1e-13 * before;
  }

  Index d_;
  Index k_;
  Index q_;
  const ReferenceElement* element_ = nullptr;
  std::vector<double> lengths_;
  double period_ = 0;

  Nodes x_, base_, step_, force_, normal_, old_normal_, trial_base_, trial_step_;
  Eigen::Matrix<double, K, Eigen::Dynamic> value_, weight_;
  Eigen::MatrixXd jacobian_, hessian_, tangents_, curvature_;
  Reduced right_, y_, negative_;
  ElementChain<Q> chain_;

  TangentFrame<D, K> frame_;
  VectorK mu_scratch_;
  VectorD vector_;
  Eigen::Matrix<double, D, Q> hessian_tangents_;
  Eigen::Matrix<double, Q, Q> curvature_block_;

  Evaluator* evaluator_ = nullptr;
  double energy_ = 0;
  double decrement_ = 0;
  double trial_energy_ = 0;  // where the last search began
  double off_surface_ = 0;
  int iterations_ = 0;
  Index evaluated_ = 0;
  bool definite_ = false;
  bool resolved_ = false;
  bool settled_ = false;
  bool regular_ends_ = false;
  double ends_off_ = 0;
  Relaxation failure_ = Relaxation::stalled;
};

}  // namespace taut::detail
