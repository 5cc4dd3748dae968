#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "surface/normal_space.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// What the geodesic equation and its linearisation need of a surface, at a batch of n points x with velocities v.
/// Notation, at one point: J^T = Q R; h_i = H_i v, H_i the Hessian of equation i; f_i = v . h_i.
///   II(u, w) = -Q R^-T (u . H_i w)_i        second fundamental form
///   a = II(v, v) = -Q y, y = R^-T f         acceleration of the geodesic
///   lambda = R^-1 y = (J J^T)^-1 f          multipliers: <II(u, w), a> = u . (sum_i lambda_i H_i) w
/// D is d at compile time, or Eigen::Dynamic. Owns the evaluator and its scratch memory.
template <int D>
class RayField {
 public:
  using VectorD = Eigen::Matrix<double, D, 1>;
  using MatrixD = Eigen::Matrix<double, D, Eigen::Dynamic>;
  /// A D known at compile time stands for one equation.
  using Normals = Eigen::Matrix<double, D, D == Eigen::Dynamic ? Eigen::Dynamic : 1>;
  /// Up to this dimension, and for one equation, the whole Hessian comes with the gradient in one visit.
  static constexpr Index kDense = 6;

  RayField(const Surface& surface, Index most_points)
      : evaluator_(surface.make_evaluator()), d_(surface.dim()), k_(surface.codim()), dense_(k_ == 1 && d_ <= kDense) {
    const Index n = most_points;
    acceleration.resize(d_, n);
    value.resize(k_, n);
    normal_velocity.resize(k_, n);
    for (auto* a : {&jacobian_, &q_, &h_}) a->resize(size(d_ * k_ * n));
    r_.resize(size(k_ * k_ * n));
    for (auto* a : {&y_, &lambda_}) a->resize(size(k_ * n));
    if (dense_) {
      hessian_.resize(size(d_ * d_ * n));
      weight_.assign(size(n), 1.0);
    } else {
      weight_.assign(size(k_ * k_ * n), 0.0);
      // Each point stands k times in a batch, with the unit weight of one equation a time: then H_i v comes alone.
      for (Index j = 0; j < n * k_; ++j) weight_[size(j * k_ + j % k_)] = 1;
      many_x_.resize(size(d_ * k_ * n));
      many_v_.resize(size(d_ * k_ * n));
    }
  }

  enum class Outcome : unsigned char { regular, singular, not_finite };

  MatrixD acceleration;             ///< d x n
  Eigen::MatrixXd value;            ///< k x n: R^-T F, so that |value| = |J^+ F|, the distance off the surface
  Eigen::MatrixXd normal_velocity;  ///< k x n: Q^T v
  Index num_evaluated = 0;

  [[nodiscard]] Index dim() const { return D > 0 ? D : d_; }
  [[nodiscard]] Index codim() const { return k_; }
  [[nodiscard]] auto normals(Index j) const {  ///< d x k, orthonormal
    return Eigen::Map<const Normals>(&q_[size(j * d_ * k_)], dim(), k_);
  }
  /// Smallest |R_ii| of point j: |grad F| for one equation.
  [[nodiscard]] double gradient(Index j) const {
    double least = std::abs(r_[size(j * k_ * k_)]);
    for (Index i = 1; i < k_; ++i) least = std::min(least, std::abs(r_[size(j * k_ * k_ + i + i * k_)]));
    return least;
  }

  /// Evaluates everything at n points. Stops at the first one where J loses rank or something is not finite.
  Outcome evaluate(Index n, const double* x, const double* v) {
    num_evaluated += n;
    PointBatch batch{.n = n, .x = x, .value = value.data(), .jacobian = jacobian_.data()};
    if (dense_) {
      batch.weight = weight_.data();
      batch.hessian = hessian_.data();
      evaluator_->evaluate(batch);
      for (Index j = 0; D != 3 && j < n; ++j) {
        Eigen::Map<VectorD>(&h_[size(j * d_)], dim()).noalias() =
            hessian(j) * Eigen::Map<const VectorD>(v + j * d_, dim());
      }
    } else {
      evaluator_->evaluate(batch);
      for (Index j = 0; j < n; ++j) {
        for (Index i = 0; i < k_; ++i) {
          std::copy_n(x + j * d_, d_, &many_x_[size((j * k_ + i) * d_)]);
          std::copy_n(v + j * d_, d_, &many_v_[size((j * k_ + i) * d_)]);
        }
      }
      evaluator_->hessian_times({.n = n * k_, .x = many_x_.data(), .weight = weight_.data()}, many_v_.data(),
                                h_.data());
    }
    return complete(n, v);
  }

  /// The accelerations of n points on a surface in space alone; `v` and `a` n x 3, a coordinate contiguous. What else
  /// is known of the points then `complete` gathers. False where that has to tell why.
  [[nodiscard]] bool accelerate_only(Index n, const double* x, const double* v, double* a) requires(D == 3) {
    num_evaluated += n;
    evaluator_->evaluate({.n = n,
                          .x = x,
                          .value = value.data(),
                          .jacobian = jacobian_.data(),
                          .weight = weight_.data(),
                          .hessian = hessian_.data()});
    bool fine = true;
    for (Index j = 0; j < n; ++j) {
      const double* g = &jacobian_[size(3 * j)];
      const double* h = &hessian_[size(9 * j)];
      const double u = v[j];
      const double w = v[n + j];
      const double z = v[2 * n + j];
      const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
      const double bent =
          (h[0] * u * u + h[4] * w * w + h[8] * z * z) + 2 * (h[1] * u * w + h[2] * u * z + h[5] * w * z);
      const double lambda = bent / square;
      // Squares of very large or small gradients lose digits: `complete` can do without them.
      fine = fine && square > 1e-200 && square < 1e200 && std::abs(lambda) < 1e200 && std::isfinite(value(0, j));
      for (Index c = 0; c < 3; ++c) a[c * n + j] = -lambda * g[c];
    }
    return fine;
  }

  /// Everything at the points of the last visit. Stops at the first one where J loses rank or something is not finite.
  Outcome complete(Index n, const double* v) {
    if (D == 3) {
      for (Index j = 0; j < n; ++j) {
        Eigen::Map<VectorD>(&h_[size(j * d_)], dim()).noalias() =
            hessian(j) * Eigen::Map<const VectorD>(v + j * d_, dim());
      }
    }
    for (Index j = 0; j < n; ++j) {
      const Outcome outcome = accelerate(j, v + j * d_);
      if (outcome != Outcome::regular) return outcome;
    }
    return Outcome::regular;
  }

  /// Gaussian curvature of a surface in space at point j, e the unit normal of v within the surface.
  [[nodiscard]] double gauss_curvature(Index j, const VectorD& e) const requires(D == 3) {
    const double bend = e.dot(Eigen::Map<const VectorD>(&h_[size(3 * j)])) / r_[size(j)];
    return lambda_[size(j)] * e.dot(hessian(j) * e) - bend * bend;
  }

  /// The second fundamental form of v and each column of `frame` (d x q) at point j, as coordinates y (k x q) with
  /// II(v, e) = -Q y.
  template <class Frame>
  void bend(Index j, const Eigen::MatrixBase<Frame>& frame, Eigen::MatrixXd& y) const {
    y.noalias() = Eigen::Map<const MatrixD>(&h_[size(j * d_ * k_)], dim(), k_).transpose() * frame;
    for (Index b = 0; b < y.cols(); ++b) {
      NormalSpace<Eigen::Dynamic>::solve(k_, &r_[size(j * k_ * k_)], y.col(b).data(), y.col(b).data());
    }
  }

  /// (sum_i lambda_i H_i) e for the columns e of the frames of n points: `frames`, `out` d x q x n. For the points of
  /// the last visit.
  void bend_along(Index n, const double* x, Index q, const double* frames, double* out) {
    if (dense_) {
      for (Index j = 0; j < n; ++j) {
        Eigen::Map<MatrixD>(out + j * q * d_, dim(), q).noalias() =
            lambda_[size(j)] * (hessian(j) * Eigen::Map<const MatrixD>(frames + j * q * d_, dim(), q));
      }
      return;
    }
    num_evaluated += n * q;
    field_x_.resize(size(n * q * d_));
    field_weight_.resize(size(n * q * k_));
    for (Index j = 0; j < n; ++j) {
      for (Index b = 0; b < q; ++b) {
        std::copy_n(x + j * d_, d_, &field_x_[size((j * q + b) * d_)]);
        std::copy_n(&lambda_[size(j * k_)], k_, &field_weight_[size((j * q + b) * k_)]);
      }
    }
    evaluator_->hessian_times({.n = n * q, .x = field_x_.data(), .weight = field_weight_.data()}, frames, out);
  }

 private:
  static std::size_t size(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] auto hessian(Index j) const {
    return Eigen::Map<const Eigen::Matrix<double, D, D>>(&hessian_[size(j * d_ * d_)], dim(), dim());
  }

  Outcome accelerate(Index j, const double* v) {
    if (D > 0 && k_ == 1) return accelerate_by_gradient(j, v);
    double* q = &q_[size(j * d_ * k_)];
    double* r = &r_[size(j * k_ * k_)];
    double* y = &y_[size(j * k_)];
    double* lambda = &lambda_[size(j * k_)];
    // Looked at before the factorisation, whose rank a NaN would spoil: not finite is told apart from singular.
    if (!value.col(j).allFinite()) return Outcome::not_finite;
    if (NormalSpace<D>::factor(dim(), k_, &jacobian_[size(j * d_ * k_)], q, r) < k_) {
      return Eigen::Map<const Vector>(&jacobian_[size(j * d_ * k_)], d_ * k_).allFinite() ? Outcome::singular
                                                                                          : Outcome::not_finite;
    }
    NormalSpace<D>::solve(k_, r, value.col(j).data(), value.col(j).data());
    for (Index i = 0; i < k_; ++i) {
      y[i] = NormalSpace<D>::dot(dim(), &h_[size((j * k_ + i) * d_)], v);
      normal_velocity(i, j) = NormalSpace<D>::dot(dim(), q + i * dim(), v);
    }
    NormalSpace<D>::solve(k_, r, y, y);
    auto a = acceleration.col(j);
    a.setZero();
    for (Index i = 0; i < k_; ++i) {
      for (Index c = 0; c < dim(); ++c) a(c) -= y[i] * q[i * dim() + c];
    }
    // lambda = R^-1 y, from the last equation up.
    for (Index i = k_; i-- > 0;) {
      lambda[i] = y[i];
      for (Index l = i + 1; l < k_; ++l) lambda[i] -= r[i + l * k_] * lambda[l];
      lambda[i] /= r[i + i * k_];
    }
    return a.allFinite() ? Outcome::regular : Outcome::not_finite;
  }

  /// The same for one equation, without loops over equations: J^T = |g| n. A third of a ray's time went there.
  Outcome accelerate_by_gradient(Index j, const double* velocity) {
    const VectorD g = Eigen::Map<const VectorD>(&jacobian_[size(j * d_)], dim());
    const VectorD v = Eigen::Map<const VectorD>(velocity, dim());
    const VectorD h = Eigen::Map<const VectorD>(&h_[size(j * d_)], dim());
    double length = g.norm();
    if (!(length > 1e-100 && length < 1e100)) {
      if (!g.allFinite()) return Outcome::not_finite;
      length = NormalSpace<D>::norm(dim(), g.data());
      if (!(length > 0)) return Outcome::singular;
    }
    const VectorD n = g / length;
    const double y = h.dot(v) / length;
    Eigen::Map<VectorD>(&q_[size(j * d_)], dim()) = n;
    r_[size(j)] = length;
    lambda_[size(j)] = y / length;
    value(0, j) /= length;
    normal_velocity(0, j) = n.dot(v);
    acceleration.col(j) = -y * n;
    return std::isfinite(value(0, j)) && std::isfinite(y) ? Outcome::regular : Outcome::not_finite;
  }

  std::unique_ptr<Evaluator> evaluator_;
  Index d_;
  Index k_;
  bool dense_;
  std::vector<double> jacobian_, q_, r_, h_, y_, lambda_, hessian_, weight_;
  std::vector<double> many_x_, many_v_, field_x_, field_weight_;
};

}  // namespace taut::detail
