#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "curve/gauss_collocation.hpp"
#include "curve/ray_field.hpp"

namespace taut::detail {

/// Where a ray is: a point of the surface and a unit tangent there, with what is known of the surface there.
struct RayState {
  Vector x;                 ///< d
  Vector v;                 ///< d
  Vector acceleration;      ///< d
  Eigen::MatrixXd normals;  ///< d x k
};

/// One step of a geodesic, x'' = II(x', x'), by Gauss collocation (order 2 kStages, symmetric). The nodes are solved
/// for by Picard iteration, all of them in one batch a visit. The defect between the nodes tells the step's error.
template <int D>
class RayStep {
 public:
  using Tables = GaussCollocation;
  static constexpr int kStages = Tables::kStages;
  using VectorD = Eigen::Matrix<double, D, 1>;
  using NodeMatrix = Eigen::Matrix<double, D, kStages>;

  enum class Verdict : unsigned char {
    good,      // the figures below tell how good
    diverged,  // the iteration does not settle: the step is too long
    folded,    // the normals turn by a great deal between two points, or the curve leaves the surface: a fold, a crease
    singular,  // J loses rank
    not_finite,  // F or a derivative is not finite
  };

  explicit RayStep(const Surface& surface) : nodes_(surface, kStages), checks_(surface, kStages) {
    const Index d = surface.dim();
    for (NodeMatrix* m : {&a_, &x_, &v_, &before_, &check_x_, &check_v_, &legendre_}) m->resize(d, kStages);
    end_x_.resize(d);
    end_v_.resize(d);
    legendre_.setZero();
  }

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
  typename RayField<D>::Outcome look(RayState& state) {
    const auto outcome = checks_.evaluate(1, state.x.data(), state.v.data());
    if (outcome == RayField<D>::Outcome::regular) {
      state.acceleration = checks_.acceleration.col(0);
      state.normals = checks_.normals(0);
      weakest = checks_.gradient(0);
      legendre_.setZero();
      legendre_.col(0) = state.acceleration;
      h_ = 1;
    }
    return outcome;
  }

  /// Tries a step of length h. The first guess is the last attempt's series, on which this step begins at `offset`
  /// (0: the same step again, 1: the next one).
  Verdict attempt(const RayState& from, double h, double offset) {
    predict(from, h / h_, offset);
    h_ = h;
    const Verdict settled = settle(from);
    legendre_.noalias() = a_.lazyProduct(tables_.to_legendre);
    return settled == Verdict::good ? check(from) : settled;
  }

  /// The end of the step: back on the surface (as far as the step may have left it; what is more is the noise of F),
  /// the velocity tangent and of unit length.
  void arrive(RayState& state) {
    const Index last = kStages - 1;
    state.normals = checks_.normals(last);
    state.acceleration = checks_.acceleration.col(last);
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * end_x_.template lpNorm<Eigen::Infinity>();
    const double drift = error_x + h_ * lift + rounding;
    const double share = off_surface > drift ? drift / off_surface : 1;
    state.x = end_x_ - share * (state.normals * checks_.value.col(last));
    state.v = end_v_ - state.normals * (state.normals.transpose() * end_v_);
    state.v /= state.v.norm();
  }

  /// x at tau in [0, 1] of the last attempt, to the order of its nodes (not of its end).
  [[nodiscard]] Vector point(const RayState& from, double tau) const {
    Eigen::Matrix<double, kStages, 1> first;
    Eigen::Matrix<double, kStages, 1> second;
    Tables::legendre_integrals(tau, first, second);
    return from.x + tau * h_ * from.v + h_ * h_ * (legendre_ * second);
  }

 private:
  /// The first guess: the last attempt's series, or, where that is carried too far, the acceleration at the start.
  void predict(const RayState& from, double ratio, double offset) {
    Eigen::Matrix<double, kStages, kStages> basis;
    for (int i = 0; i < kStages; ++i) Tables::legendre(offset + tables_.node(i) * ratio, basis.col(i));
    a_.noalias() = legendre_.lazyProduct(basis);
    const double most = 2 * std::max(from.acceleration.norm(), legendre_.cwiseAbs().maxCoeff());
    for (int i = 0; i < kStages; ++i) {
      if (!(a_.col(i).norm() <= most)) a_.col(i) = from.acceleration;
    }
  }

  Verdict settle(const RayState& from) {
    constexpr int kMostVisits = 40;
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    double last_change = std::numeric_limits<double>::infinity();
    int stalled = 0;
    num_visits = 0;
    for (int visit = 0; visit < kMostVisits; ++visit) {
      v_.noalias() = h_ * a_.lazyProduct(tables_.once);
      v_.colwise() += from.v;
      x_.noalias() = (h_ * h_) * a_.lazyProduct(tables_.twice);
      x_.noalias() += (h_ * from.v).lazyProduct(tables_.node);
      x_.colwise() += from.x;
      ++num_visits;
      const auto outcome = nodes_.evaluate(kStages, x_.data(), v_.data());
      if (outcome == RayField<D>::Outcome::not_finite) return Verdict::not_finite;
      if (outcome == RayField<D>::Outcome::singular) return Verdict::singular;
      before_ = a_;
      a_ = nodes_.acceleration.leftCols(kStages);
      const double change = (a_ - before_).cwiseAbs().maxCoeff() * h_;
      const double most = a_.cwiseAbs().maxCoeff() * h_;
      if (!(most <= 20)) return Verdict::diverged;
      // What the next visit would change: the changes shrink by a factor a visit.
      const double ahead = visit > 0 ? change * std::min(1.0, change / last_change) : change;
      if (ahead <= kEpsilon * std::max(most, 0.01)) break;
      if (visit > 1 && change > 0.5 * last_change) {
        if (change <= 1e-9) {
          if (++stalled == 2) break;  // rounding of F
        } else if (change > 1.5 * last_change || ++stalled == 3) {
          return Verdict::diverged;
        }
      }
      if (visit + 1 == kMostVisits) return Verdict::diverged;
      last_change = change;
    }
    return Verdict::good;
  }

  Verdict check(const RayState& from) {
    const auto& inner = tables_.check;
    check_v_.noalias() = h_ * a_.lazyProduct(tables_.check_once.template rightCols<kStages>());
    check_v_.colwise() += from.v;
    check_x_.noalias() = (h_ * h_) * a_.lazyProduct(tables_.check_twice.template rightCols<kStages>());
    check_x_.noalias() += (h_ * from.v).lazyProduct(inner.template rightCols<kStages>());
    check_x_.colwise() += from.x;
    const auto outcome = checks_.evaluate(kStages, check_x_.data(), check_v_.data());
    if (outcome == RayField<D>::Outcome::not_finite) return Verdict::not_finite;
    if (outcome == RayField<D>::Outcome::singular) return Verdict::singular;
    if (!normals_agree(from)) return Verdict::folded;

    curvature = std::sqrt(a_.colwise().squaredNorm().maxCoeff());
    const Index last = kStages - 1;
    end_x_ = check_x_.col(last);
    end_v_ = check_v_.col(last);
    off_surface = checks_.value.col(last).norm();
    lift = checks_.normal_velocity.col(last).norm();

    Eigen::Matrix<double, D, Tables::kChecks> defect(end_x_.size(), Tables::kChecks);
    defect.noalias() = a_.lazyProduct(tables_.check_value);
    defect.col(0) -= from.acceleration;
    defect.template rightCols<kStages>() -= checks_.acceleration.leftCols(kStages);
    const Eigen::Matrix<double, D, 3> moment = defect.lazyProduct(tables_.defect_moment.transpose());
    const double m0 = moment.col(0).norm();
    const double m1 = moment.col(1).norm();
    const double bend = std::max(1e-2, curvature * h_);
    // What becomes of a defect by the end varies along the step about like exp(bend tau), to 1, bend / 2, bend^2 / 12
    // of P_0, P_1, P_2.
    error_v = h_ * (m0 + bend / 2 * m1 + bend * bend / 12 * moment.col(2).norm()) + lift + std::abs(end_v_.norm() - 1);
    error_x = h_ * h_ * (m0 + m1) / 2;
    resolution = h_ * std::sqrt(defect.colwise().squaredNorm().maxCoeff());
    // Inside a step the curve keeps to the surface as well as it is resolved; a crease it would leave the surface at.
    constexpr double kClose = 1e-8;
    const double allowed = kClose * h_ + 1e-12 * end_x_.template lpNorm<Eigen::Infinity>() + error_x + h_ * lift;
    if (off_surface > allowed) return Verdict::folded;
    return std::isfinite(error_v + error_x + resolution) ? Verdict::good : Verdict::not_finite;
  }

  /// From each point to the next the normal space turns by less than 60 degrees and keeps its orientation: no singular
  /// point, and no other sheet, was stepped over.
  bool normals_agree(const RayState& from) {
    weakest = std::numeric_limits<double>::infinity();
    Index k = nodes_.codim();
    const auto close = [&](const auto& a, const auto& b) {
      if (k == 1) return a.col(0).dot(b.col(0)) > 0.5;
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
  RayField<D> nodes_;
  RayField<D> checks_;
  double h_ = 1;
  NodeMatrix a_, x_, v_, before_, check_x_, check_v_;
  NodeMatrix legendre_;  // d x kStages: the last attempt's acceleration
  VectorD end_x_, end_v_;
};

}  // namespace taut::detail
