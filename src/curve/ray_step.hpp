#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "curve/gauss_collocation.hpp"
#include "curve/integrate_nodes.hpp"
#include "curve/ray_field.hpp"

namespace taut::detail {

/// Where a ray is: a point of the surface and a unit tangent there, with what is known of the surface there.
template <int D>
struct RayState {
  Eigen::Matrix<double, D, 1> x;
  Eigen::Matrix<double, D, 1> v;
  Eigen::Matrix<double, D, 1> acceleration;
  typename RayField<D>::Normals normals;  ///< d x k
};

/// What GaussCollocation tells of the nodes and checks of a step, a row each: applied to one node value a row, it
/// runs through contiguous numbers.
struct RayRows {
  using Square = GaussCollocation::Square;
  NodeWeights nodes;
  NodeWeights checks;  ///< but the first, which is the start of the step
  Square to_legendre;  ///< row i: weights of the i-th coefficient
  Eigen::Matrix<double, GaussCollocation::kChecks, GaussCollocation::kStages> check_value;

  [[nodiscard]] static const RayRows& tables() {
    static const RayRows rows = [] {
      const GaussCollocation& t = GaussCollocation::tables();
      constexpr int kStages = GaussCollocation::kStages;
      return RayRows{
          .nodes = {t.once.transpose(), t.twice.transpose(), t.node.transpose()},
          .checks = {t.check_once.rightCols<kStages>().transpose(), t.check_twice.rightCols<kStages>().transpose(),
                     t.check.rightCols<kStages>().transpose()},
          .to_legendre = t.to_legendre.transpose(),
          .check_value = t.check_value.transpose()};
    }();
    return rows;
  }
};

/// One step of a geodesic, x'' = II(x', x'), by Gauss collocation (order 2 kStages, symmetric). The nodes are solved
/// for by Picard iteration, all of them in one batch a visit. The defect between the nodes tells the step's error.
template <int D>
class RayStep {
 public:
  using Tables = GaussCollocation;
  static constexpr int kStages = Tables::kStages;
  using State = RayState<D>;
  using VectorD = Eigen::Matrix<double, D, 1>;
  using NodeMatrix = Eigen::Matrix<double, D, kStages>;
  using NodeRows =
      Eigen::Matrix<double, kStages, D>;  ///< a node a row: what a coordinate is at the nodes is contiguous

  enum class Verdict : unsigned char {
    good,      // the figures below tell how good
    diverged,  // the iteration does not settle: the step is too long
    folded,    // the normals turn by a great deal between two points, or the curve leaves the surface: a fold, a crease
    singular,  // J loses rank
    not_finite,  // F or a derivative is not finite
  };

  explicit RayStep(const Surface& surface) : nodes_(surface, kStages), checks_(surface, kStages) {
    const Index d = surface.dim();
    for (NodeMatrix* m : {&x_, &v_, &check_x_, &check_v_}) m->resize(d, kStages);
    for (NodeRows* m : {&a_, &next_, &x_rows_, &v_rows_, &legendre_}) m->resize(kStages, d);
    end_x_.resize(d);
    end_v_.resize(d);
    legendre_.setZero();
  }

  /// The iteration for the nodes ends where the velocity would change by this part of how much it turns.
  double enough = std::numeric_limits<double>::epsilon();

  double error_x = 0;      ///< of the end, model units
  double error_v = 0;      ///< of the end, radians
  double resolution = 0;   ///< radians: how much the velocity changes by the largest defect, to the step's length
  double curvature = 0;    ///< largest |a|
  double weakest = 0;      ///< least |grad F| (|R_ii|) met
  double off_surface = 0;  ///< |J^+ F| at the end
  double lift = 0;         ///< |Q^T v| at the end
  int num_visits = 0;

  [[nodiscard]] RayField<D>& nodes() { return nodes_; }
  [[nodiscard]] const NodeMatrix& node_x() const { return x_; }
  [[nodiscard]] const NodeMatrix& node_v() const { return v_; }
  [[nodiscard]] const NodeMatrix& check_x() const { return check_x_; }  ///< kStages points, the last one is the end
  [[nodiscard]] Index num_evaluated() const { return nodes_.num_evaluated + checks_.num_evaluated; }
  [[nodiscard]] double step() const { return h_; }

  /// What is known of a point before any step.
  typename RayField<D>::Outcome look(State& state) {
    const auto outcome = checks_.evaluate(1, state.x.data(), state.v.data());
    if (outcome == RayField<D>::Outcome::regular) {
      state.acceleration = checks_.acceleration.col(0);
      state.normals = checks_.normals(0);
      weakest = checks_.gradient(0);
      legendre_.setZero();
      legendre_.row(0) = state.acceleration.transpose();
      h_ = 1;
    }
    return outcome;
  }

  /// Tries a step of length h. The first guess is the last attempt's series, on which this step begins at `offset`
  /// (0: the same step again, 1: the next one).
  Verdict attempt(const State& from, double h, double offset) {
    predict(from, h / h_, offset);
    h_ = h;
    const Verdict settled = settle(from);
    legendre_.noalias() = rows_.to_legendre.lazyProduct(a_);
    return settled == Verdict::good ? check(from) : settled;
  }

  /// The end of the step: back on the surface (as far as the step may have left it; what is more is the noise of F),
  /// the velocity tangent and of unit length.
  void arrive(State& state) {
    const Index last = kStages - 1;
    state.normals = checks_.normals(last);
    state.acceleration = checks_.acceleration.col(last);
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * end_x_.template lpNorm<Eigen::Infinity>();
    // How far the step itself may have come off the surface.
    const double drift = error_x + h_ * lift + rounding;
    // Farther off than the step's own error explains: noise of F, which a projection would turn into a jump.
    const double share = off_surface > drift ? drift / off_surface : 1;
    state.x = end_x_ - share * (state.normals * checks_.value.col(last));
    state.v = end_v_ - state.normals * (state.normals.transpose() * end_v_);
    state.v /= state.v.norm();
  }

  /// x at tau in [0, 1] of the last attempt, to the order of its nodes (not of its end).
  [[nodiscard]] Vector point(const State& from, double tau) const {
    Eigen::Matrix<double, kStages, 1> first;
    Eigen::Matrix<double, kStages, 1> second;
    Tables::legendre_integrals(tau, first, second);
    return from.x + tau * h_ * from.v + h_ * h_ * (legendre_.transpose() * second);
  }

 private:
  using Outcome = typename RayField<D>::Outcome;

  /// The first guess: the last attempt's series, or, where that is carried too far, the acceleration at the start.
  void predict(const State& from, double ratio, double offset) {
    using Nodes = Eigen::Array<double, kStages, 1>;
    const Nodes xi = 2 * (offset + rows_.nodes.at.array() * ratio) - 1;
    Eigen::Matrix<double, kStages, kStages> basis;
    basis.col(0).setOnes();
    basis.col(1) = xi;
    for (int n = 2; n < kStages; ++n) {
      basis.col(n) = ((2 * n - 1) * xi * basis.col(n - 1).array() - (n - 1) * basis.col(n - 2).array()) / n;
    }
    a_.noalias() = basis.lazyProduct(legendre_);
    // A polynomial carried past its step grows without bound.
    const double most = 2 * std::max(from.acceleration.norm(), legendre_.cwiseAbs().maxCoeff());
    for (int i = 0; i < kStages; ++i) {
      if (!(a_.row(i).norm() <= most)) a_.row(i) = from.acceleration.transpose();
    }
  }

  /// Accelerations at the nodes for the positions and velocities there: `next_`.
  typename RayField<D>::Outcome visit() {
    x_ = x_rows_.transpose();
    if constexpr (D == 3) {
      if (nodes_.accelerate_only(kStages, x_.data(), v_rows_.data(), next_.data())) return Outcome::regular;
      v_ = v_rows_.transpose();
      const Outcome outcome = nodes_.complete(kStages, v_.data());
      if (outcome != Outcome::regular) return outcome;
    } else {
      v_ = v_rows_.transpose();
      const Outcome outcome = nodes_.evaluate(kStages, x_.data(), v_.data());
      if (outcome != Outcome::regular) return outcome;
    }
    next_ = nodes_.acceleration.leftCols(kStages).transpose();
    return Outcome::regular;
  }

  void integrate(const NodeWeights& weights, const State& from) {
    integrate_nodes(weights, a_.cols(), h_, from.x.data(), from.v.data(), a_.data(), v_rows_.data(), x_rows_.data());
  }

  Verdict settle(const State& from) {
    constexpr int kMostVisits = 40;
    double last_change = std::numeric_limits<double>::infinity();
    int stalled = 0;
    num_visits = 0;
    for (int visits = 0; visits < kMostVisits; ++visits) {
      integrate(rows_.nodes, from);
      ++num_visits;
      const Outcome outcome = visit();
      if (outcome == Outcome::not_finite) return Verdict::not_finite;
      if (outcome == Outcome::singular) return Verdict::singular;
      const double change = (next_ - a_).cwiseAbs().maxCoeff() * h_;
      a_.swap(next_);
      const double most = a_.cwiseAbs().maxCoeff() * h_;
      // The velocity would turn by 20 radians within the step: Picard's iteration does not contract there.
      if (!(most <= 20)) return Verdict::diverged;
      // What the next visit would change: the changes shrink by a factor a visit.
      const double ahead = visits > 0 ? change * std::min(1.0, change / last_change) : change;
      // 0.01: on flat pieces the acceleration is rounding itself.
      if (ahead <= enough * std::max(most, 0.01)) break;
      if (visits > 1 && change > 0.5 * last_change) {
        if (change <= 1e-9) {
          if (++stalled == 2) break;  // rounding of F
        } else if (change > 1.5 * last_change || ++stalled == 3) {
          return Verdict::diverged;
        }
      }
      if (visits + 1 == kMostVisits) return Verdict::diverged;
      last_change = change;
    }
    if constexpr (D == 3) {
      v_ = v_rows_.transpose();
      if (nodes_.complete(kStages, v_.data()) != Outcome::regular) return Verdict::not_finite;
    }
    return Verdict::good;
  }

  Verdict check(const State& from) {
    integrate(rows_.checks, from);
    check_x_ = x_rows_.transpose();
    check_v_ = v_rows_.transpose();
    const Outcome outcome = checks_.evaluate(kStages, check_x_.data(), check_v_.data());
    if (outcome == Outcome::not_finite) return Verdict::not_finite;
    if (outcome == Outcome::singular) return Verdict::singular;
    if (!normals_agree(from)) return Verdict::folded;

    curvature = std::sqrt(a_.rowwise().squaredNorm().maxCoeff());
    const Index last = kStages - 1;
    end_x_ = check_x_.col(last);
    end_v_ = check_v_.col(last);
    off_surface = checks_.value.col(last).norm();
    lift = checks_.normal_velocity.col(last).norm();

    Eigen::Matrix<double, Tables::kChecks, D> defect(static_cast<Index>(Tables::kChecks), end_x_.size());
    defect.noalias() = rows_.check_value.lazyProduct(a_);
    defect.row(0) -= from.acceleration.transpose();
    defect.template bottomRows<kStages>() -= checks_.acceleration.leftCols(kStages).transpose();
    const Eigen::Matrix<double, 3, D> moment = tables_.defect_moment.lazyProduct(defect);
    const double m0 = moment.row(0).norm();
    const double m1 = moment.row(1).norm();
    const double bend = std::max(1e-2, curvature * h_);
    // What becomes of a defect by the end varies along the step about like exp(bend tau), to 1, bend / 2, bend^2 / 12
    // of P_0, P_1, P_2.
    error_v = h_ * (m0 + bend / 2 * m1 + bend * bend / 12 * moment.row(2).norm()) + lift + std::abs(end_v_.norm() - 1);
    // Twice integrated: the end's place takes the defect with a weight that falls towards the end.
    error_x = h_ * h_ * (m0 + m1) / 2;
    resolution = h_ * std::sqrt(defect.rowwise().squaredNorm().maxCoeff());
    // Inside a step the curve keeps to the surface as well as it is resolved; a crease it would leave the surface at.
    constexpr double kClose = 1e-8;
    const double allowed = kClose * h_ + 1e-12 * end_x_.template lpNorm<Eigen::Infinity>() + error_x + h_ * lift;
    if (off_surface > allowed) return Verdict::folded;
    return std::isfinite(error_v + error_x + resolution) ? Verdict::good : Verdict::not_finite;
  }

  /// From each point to the next the normal space turns by less than 60 degrees and keeps its orientation: no singular
  /// point, and no other sheet, was stepped over.
  bool normals_agree(const State& from) {
    weakest = std::numeric_limits<double>::infinity();
    Index k = nodes_.codim();
    const auto close = [&](const auto& a, const auto& b) {
      if (D == 3 || k == 1) return a.col(0).dot(b.col(0)) > 0.5;
      const Eigen::MatrixXd turn = a.transpose() * b;
      return turn.colwise().norm().minCoeff() > 0.5 && turn.determinant() > 0;
    };
    if (!close(from.normals, nodes_.normals(0))) return false;
    for (Index i = 0; i < kStages; ++i) {
      weakest = std::min({weakest, nodes_.gradient(i), checks_.gradient(i)});
      if (!close(nodes_.normals(i), checks_.normals(i))) return false;
      if (i + 1 < kStages && !close(checks_.normals(i), nodes_.normals(i + 1))) return false;
    }
    return true;
  }

  const Tables& tables_ = Tables::tables();
  const RayRows& rows_ = RayRows::tables();
  RayField<D> nodes_;
  RayField<D> checks_;
  double h_ = 1;
  NodeMatrix x_, v_, check_x_, check_v_;
  NodeRows a_, next_, x_rows_, v_rows_;
  NodeRows legendre_;  // a coefficient a row: the last attempt's acceleration
  VectorD end_x_, end_v_;
};

}  // namespace taut::detail
