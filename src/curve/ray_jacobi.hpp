#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/linear_algebra.hpp"
#include "curve/ray_step.hpp"

namespace taut::detail {

/// Jacobi fields along a geodesic: how its neighbours spread. In an orthonormal frame e_1 .. e_q (q = d - k - 1) of the
/// normals of the geodesic within the surface, carried parallel along it,
///   j'' + R j = 0,   R_ab = <II(e_a, e_b), II(v, v)> - <II(e_a, v), II(e_b, v)>   (Gauss' equation);
/// for surfaces (q = 1) R is the Gaussian curvature K. Solved by the same collocation as the geodesic, on its nodes.
template <int D>
class RayJacobi {
 public:
  /// A D known at compile time stands for one equation.
  static constexpr int Q = D > 0 ? D - 2 : Eigen::Dynamic;
  static constexpr int Q2 = D > 0 ? 2 * (D - 2) : Eigen::Dynamic;
  static constexpr int kStages = GaussCollocation::kStages;
  using Frame = Eigen::Matrix<double, D, Q>;
  using Block = Eigen::Matrix<double, Q, Q>;
  using Transfer = Eigen::Matrix<double, Q2, Q2>;  ///< (j, j') at the start of a step -> at its end

  static constexpr int kFrame = D > 0 ? D* Q : Eigen::Dynamic;
  static constexpr int kBlock = D > 0 ? Q* Q : Eigen::Dynamic;
  static constexpr int kFields = D > 0 ? 2 * Q* Q : Eigen::Dynamic;
  using FieldColumn = Eigen::Matrix<double, kFields, 1>;

  RayJacobi(Index d, Index k) : d_(d), k_(k), q_(d - k - 1) {
    frame_.resize(d_, q_);
    end_frame_.resize(d_, q_);
    for (auto* m : {&frames_, &bent_, &slope_}) m->resize(d_ * q_, kStages);
    curvature_.resize(q_ * q_, kStages);
    for (auto* m : {&fields_, &pull_, &last_, &straight_}) m->resize(2 * q_ * q_, kStages);
    transfer.resize(2 * q_, 2 * q_);
    y_.resize(k_, q_);
  }

  Transfer transfer;      ///< of the last attempt
  double resolution = 0;  ///< radians: h^2 times the last terms of R's series
  double bend = 0;        ///< h^2 |R|

  [[nodiscard]] Index num_fields() const { return q_; }

  void start(const RayState<D>& state) {
    if constexpr (D == 3) {
      frame_ = state.normals.cross(state.v).normalized();
    } else {
      Eigen::MatrixXd normal(d_, k_ + 1);
      normal << state.normals, state.v;
      frame_ = orthogonal_complement(normal);
    }
    position_ = Block::Zero(q_, q_);
    velocity_ = Block::Identity(q_, q_);
    at_start_ = true;
  }

  /// Follows a step that was tried.
  void attempt(RayStep<D>& step) {
    const double h = step.step();
    carry_frame(step, h);
    find_curvature(step, h);
    solve(h);
  }

  /// Smallest eigenvalue of h B^-1 J_1 J_0^-1, J the fields that vanish at the start of the ray, A and B the upper
  /// blocks of the step's transfer. A symmetric matrix; its negative eigenvalues count the conjugate points in the
  /// step (it is a pivot of the index form), whatever their multiplicity. It is 1 for h = 0, and falls through zero
  /// transversally. In the first step there is none.
  [[nodiscard]] double margin(double h) const { return pivots(h)(0); }

  /// The conjugate points in a step, each as often as its multiplicity.
  [[nodiscard]] int num_conjugate(double h) const { return static_cast<int>((pivots(h).array() < 0).count()); }

  /// Goes on to the end of the step, where the ray now is.
  void accept(const RayState<D>& arrived) {
    Block next = transfer.topLeftCorner(q_, q_) * position_ + transfer.topRightCorner(q_, q_) * velocity_;
    velocity_ = (transfer.bottomLeftCorner(q_, q_) * position_ + transfer.bottomRightCorner(q_, q_) * velocity_).eval();
    position_ = next;
    if constexpr (Q != 1) {  // another basis of the same fields keeps them independent
      Eigen::MatrixXd stacked(2 * q_, q_);
      stacked << position_, velocity_;
      const Eigen::MatrixXd basis = thin_qr(stacked).q;
      position_ = basis.topRows(q_);
      velocity_ = basis.bottomRows(q_);
    }
    at_start_ = false;
    frame_ = end_frame_;
    for (Index b = 0; b < q_; ++b) {
      auto e = frame_.col(b);
      e -= arrived.normals * (arrived.normals.transpose() * e);
      e -= arrived.v * arrived.v.dot(e);
      // The collocation keeps the frame orthonormal to its order; this removes what is left, so that it never adds up.
      for (Index c = 0; c < b; ++c) e -= frame_.col(c) * frame_.col(c).dot(e);
      e.normalize();
    }
  }

 private:
  /// The eigenvalues that margin() speaks of, ascending; all -1 where the step is too long for them.
  [[nodiscard]] Eigen::Matrix<double, Q, 1> pivots(double h) const {
    using Values = Eigen::Matrix<double, Q, 1>;
    // All fields vanish at the start itself: J_0^-1 does not exist, and no conjugate point can be so near.
    if (at_start_) return Values::Ones(q_);
    const auto a = transfer.topLeftCorner(q_, q_);
    const Block b = transfer.topRightCorner(q_, q_) / h;
    if constexpr (Q == 1) {
      return Values(a(0, 0) / b(0, 0) + h * velocity_(0, 0) / position_(0, 0));
    } else {
      const Block riccati = velocity_ * solve_square(position_, Block::Identity(q_, q_));
      Block pivot = solve_square(b, a) + h * riccati;
      if (!pivot.allFinite()) return Values::Constant(q_, -1);
      // Symmetric but for rounding.
      pivot = ((pivot + pivot.transpose()) / 2).eval();
      return symmetric_eigenvalues(pivot);
    }
  }

  void carry_frame(RayStep<D>& step, double h) {
    const GaussCollocation& t = GaussCollocation::tables();
    auto& field = step.nodes();
    if (q_ == 1) {  // the only direction left
      for (Index i = 0; i < kStages; ++i) {
        const auto v = step.node_v().col(i);
        Eigen::Matrix<double, D, 1> e = frame_.col(0) - v * (v.dot(frame_.col(0)) / v.squaredNorm());
        const auto normals = field.normals(i);
        for (Index l = 0; l < k_; ++l) e -= normals.col(l) * normals.col(l).dot(e);
        frames_.col(i) = e / e.norm();
      }
      // Of the last node; accept() turns it into the one direction left at the end of the step.
      end_frame_ = Eigen::Map<const Frame>(frames_.col(kStages - 1).data(), d_, 1);
      return;
    }
    const Eigen::Map<const Eigen::VectorXd> from(frame_.data(), d_ * q_);
    for (int i = 0; i < kStages; ++i) frames_.col(i) = from;
    for (int visit = 0; visit < 40; ++visit) {  // e' = II(v, e)
      for (Index i = 0; i < kStages; ++i) {
        field.bend(i, Eigen::Map<const Eigen::MatrixXd>(frames_.col(i).data(), d_, q_), y_);
        Eigen::Map<Eigen::MatrixXd>(slope_.col(i).data(), d_, q_).noalias() = -(field.normals(i) * y_);
      }
      bent_.noalias() = h * slope_ * t.once;
      bent_.colwise() += from;
      const double change = (bent_ - frames_).cwiseAbs().maxCoeff();
      frames_.swap(bent_);
      if (!(change > 1e-16)) break;
    }
    Eigen::Map<Eigen::VectorXd>(end_frame_.data(), d_ * q_) = from + h * slope_ * t.end_once.transpose();
  }

  void find_curvature(RayStep<D>& step, double h) {
    const GaussCollocation& t = GaussCollocation::tables();
    auto& field = step.nodes();
    if constexpr (D == 3) {
      for (Index i = 0; i < kStages; ++i) curvature_(0, i) = field.gauss_curvature(i, frames_.col(i));
      bend = h * h * curvature_.cwiseAbs().maxCoeff();
      resolution = h * h * curvature_.lazyProduct(t.to_legendre.template rightCols<2>()).cwiseAbs().maxCoeff();
      return;
    }
    field.bend_along(kStages, step.node_x().data(), q_, frames_.data(), bent_.data());
    for (Index i = 0; i < kStages; ++i) {
      const Eigen::Map<const Frame> e(frames_.col(i).data(), d_, q_);
      const Eigen::Map<const Frame> he(bent_.col(i).data(), d_, q_);
      field.bend(i, e, y_);
      Eigen::Map<Block>(curvature_.col(i).data(), q_, q_).noalias() = e.transpose() * he - y_.transpose() * y_;
    }
    bend = h * h * curvature_.cwiseAbs().maxCoeff();
    resolution = h * h * (curvature_ * t.to_legendre.template rightCols<2>()).cwiseAbs().maxCoeff();
  }

  /// The transfer matrix: 2 q fields, of which q start as e_a and q with slope e_a.
  void solve(double h) {
    const GaussCollocation& t = GaussCollocation::tables();
    using Fields = Eigen::Matrix<double, Q, Q2>;
    const Index m = 2 * q_;
    Fields base(q_, m);
    for (Index i = 0; i < kStages; ++i) {
      base << Block::Identity(q_, q_), h * t.node(i) * Block::Identity(q_, q_);
      Eigen::Map<Fields>(fields_.col(i).data(), q_, m) = base;
    }
    // Fields on a flat surface: the part of the solution that R has nothing to do with.
    straight_ = fields_;
    const double enough = 1e-16 * std::max(1.0, h);  // a visit more would change a tenth of that at most
    for (int visit = 0; visit < 60; ++visit) {
      for (Index i = 0; i < kStages; ++i) {
        Eigen::Map<Fields>(pull_.col(i).data(), q_, m).noalias() =
            -(Eigen::Map<const Block>(curvature_.col(i).data(), q_, q_) *
              Eigen::Map<const Fields>(fields_.col(i).data(), q_, m));
      }
      last_ = straight_;
      last_.noalias() += (h * h) * pull_.lazyProduct(t.twice);
      const double change = (last_ - fields_).cwiseAbs().maxCoeff();
      fields_.swap(last_);
      if (!(change > enough)) break;
    }
    const FieldColumn gain = h * pull_.lazyProduct(t.end_once.transpose());
    const FieldColumn shift = (h * h) * pull_.lazyProduct(t.end_twice.transpose());
    base << Block::Identity(q_, q_), h * Block::Identity(q_, q_);
    transfer.topRows(q_) = base + Eigen::Map<const Fields>(shift.data(), q_, m);
    base << Block::Zero(q_, q_), Block::Identity(q_, q_);
    transfer.bottomRows(q_) = base + Eigen::Map<const Fields>(gain.data(), q_, m);
  }

  Index d_, k_, q_;
  Frame frame_, end_frame_;
  Block position_, velocity_;  // J and J' of the fields that vanish at the start of the ray
  bool at_start_ = true;
  Eigen::Matrix<double, kFrame, kStages> frames_, bent_, slope_;             // d q x kStages
  Eigen::Matrix<double, kBlock, kStages> curvature_;                         // q q x kStages
  Eigen::Matrix<double, kFields, kStages> fields_, pull_, last_, straight_;  // 2 q q x kStages
  Eigen::MatrixXd y_;                                                        // k x q
};

}  // namespace taut::detail
