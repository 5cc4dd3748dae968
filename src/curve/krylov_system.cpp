// Newton's systems for many tangent directions, without a matrix (notation in krylov_system.hpp). Solves:
// preconditioned conjugate gradients (Hestenes and Stiefel 1952) on tangent fields, the preconditioner being the
// inverse of the stiffness K, projected. Second variation: Lanczos' method on the same preconditioned operator for its
// least eigenvalue. A product costs one visit of the evaluator, and O(d) a node besides; kMostSteps and
// kMostLanczosSteps bound their number.
#include "curve/krylov_system.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace taut::detail {
namespace {

/// The residual of a Newton step relative to its right side, in the norm of the preconditioner: the energy it leaves
/// behind is the square of this part of what the exact step gains.
constexpr double kForcing = 1e-3;
constexpr int kMostSteps = 400;
/// ... and the residual that rounding allows, relative to the curve in the norm of its stiffness.
constexpr double kExact = 1e-15;
/// A least eigenvalue below this is rounding.
constexpr double kLeast = 1e-13;
/// Below this it counts as soft.
constexpr double kLevel = 1e-4;
/// How much more the gradient counts in a start vector than random numbers.
constexpr double kDownhill = 10;
/// Directions of less curvature than this, relative to their stiffness, are neutral (ends that are conjugate).
constexpr double kNeutral = 1e-7;
constexpr int kLeastLanczosSteps = 12;
constexpr int kMostLanczosSteps = 240;
constexpr int kLookEvery = 8;  // looks at k eigenvalues cost k^3: the next one after a step in so many
/// A link this weak is rounding: the vectors so far span everything the start has parts in.
constexpr double kExhausted = 1e-9;

}  // namespace

KrylovSystem::KrylovSystem(Index dim, Index codim) : d_(dim), k_(codim), scratch_(dim), overlap_(codim) {}

void KrylovSystem::resize(const Curve& curve) {
  num_negative_ = 0;
  conclusive_ = false;
  has_negative_ = false;
  least_left_ = std::numeric_limits<double>::infinity();
  const Index n = curve.num_nodes();
  normals_.resize(d_ * k_, n);
  for (Nodes* field : {&right_, &y_, &residual_, &direction_, &product_, &scaled_, &negative_}) field->setZero(d_, n);
  const int p = curve.degree();
  stiffness_.reset(n - 2, p);
  inside_.reset(n - 2, p);
  for (Index e = 0; e < curve.num_elements(); ++e) {
    for (int i = 0; i <= p; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Index row = e * p + i - 1;  // of the inner nodes
        const Index column = e * p + j - 1;
        if (column < 0 || row >= n - 2) continue;
        const double entry = curve.scale(e) * curve.element->stiffness(i, j);
        stiffness_.at(row, column) += entry;
        // Fields that vanish at every element end: their rows are cut off, only the diagonal is kept to be factored.
        const bool at_end = i == p || j == 0;
        if (!at_end || i == j) inside_.at(row, column) += entry;
      }
    }
  }
  // Stiffness matrices with fixed ends are positive definite.
  (void)stiffness_.factor();
  (void)inside_.factor();
}

double KrylovSystem::turn(Index i, Index j) const {
  const Eigen::Map<const Eigen::MatrixXd> a(normals_.col(i).data(), d_, k_);
  const Eigen::Map<const Eigen::MatrixXd> b(normals_.col(j).data(), d_, k_);
  // The normal spaces turn by the same angles as the tangent spaces.
  const double lost = static_cast<double>(k_) - (a.transpose() * b).squaredNorm();
  return std::asin(std::sqrt(std::clamp(lost, 0.0, 1.0)));
}

void KrylovSystem::project(Nodes& field) const {
  const Index n = field.cols();
  field.col(0).setZero();
  field.col(n - 1).setZero();
  for (Index j = 1; j + 1 < n; ++j) {
    const Eigen::Map<const Eigen::MatrixXd> normals(normals_.col(j).data(), d_, k_);
    overlap_.noalias() = normals.transpose() * field.col(j);
    field.col(j).noalias() -= normals * overlap_;
  }
}

void KrylovSystem::linearise(Evaluator& evaluator, Curve& curve, Frame& frame) {
  const Index n = curve.num_nodes();
  for (Index j = 1; j + 1 < n; ++j) {
    frame.compute(curve.gradients(j));
    frame.multipliers(curve.force.col(j), curve.weight.col(j));
  }
  curve.weight.col(0).setZero();
  curve.weight.col(n - 1).setZero();
  curve.off.col(0).setZero();
  curve.off.col(n - 1).setZero();
  // Right side -P (K (x + n) + mu Hess F n); `force` is K (x + n) already.
  evaluator.hessian_times({.n = n, .x = curve.x.data(), .weight = curve.weight.data()}, curve.off.data(),
                          right_.data());
  right_ = -right_ - curve.force;
  project(right_);
}

void KrylovSystem::apply(const Curve& curve, Evaluator& evaluator, bool curvature, const Nodes& field, Nodes& out) {
  curve.apply_stiffness(field, out, scratch_);
  if (curvature) {
    evaluator.hessian_times({.n = curve.num_nodes(), .x = curve.x.data(), .weight = curve.weight.data()}, field.data(),
                            scaled_.data());
    out += scaled_;
  }
  project(out);
}

void KrylovSystem::precondition(const BandedCholesky& stiffness, const Nodes& field, Nodes& out) const {
  out = field;
  if (out.cols() > 2) stiffness.solve_rows(out.middleCols(1, out.cols() - 2));
  project(out);
}

// Legend: residual r = b - A y, z = P G r its correction, s the direction searched.
bool KrylovSystem::factor(const Curve& curve, Evaluator& evaluator, bool curvature, bool definite) {
  Nodes& r = residual_;
  Nodes& s = direction_;
  Nodes z(r.rows(), r.cols());
  if (curvature) {
    num_negative_ = 0;
    conclusive_ = false;
    has_negative_ = false;
  }
  y_.setZero();
  r = right_;
  precondition(stiffness_, r, z);
  s = z;
  double rz = dot(r, z);
  // Inexact Newton: the residual matters by its square only, once the step is taken.
  const double enough = kForcing * kForcing * rz;
  const double rounding = kExact * kExact * curve.apply_stiffness(curve.x, product_, scratch_);
  // As far as confirm_minimum asks for, but not below rounding.
  const double goal = std::max(std::min(enough, least_left_), std::min(enough, rounding));
  for (int step = 0; step < kMostSteps && rz > goal; ++step) {
    apply(curve, evaluator, curvature, s, product_);
    const double bend = dot(s, product_);
    if (!std::isfinite(bend)) return false;
    // The s . A s are the pivots of A on the space searched so far: their negative ones count its negative directions.
    if (bend <= 0) {
      if (definite) {
        negative_ = s;
        has_negative_ = true;
        num_negative_ = 1;
        return false;
      }
      if (bend == 0) return false;
      ++num_negative_;
    }
    const double alpha = rz / bend;
    y_ += alpha * s;
    r -= alpha * product_;
    precondition(stiffness_, r, z);
    const double next = dot(r, z);
    s = z + (next / rz) * s;
    rz = next;
  }
  left_ = rz;
  return rz <= enough;
}

double KrylovSystem::solve(Nodes& step) const {
  step = y_;
  return -dot(right_, y_);
}

SoftDirection KrylovSystem::soft_direction(const Curve& curve, Evaluator& evaluator) {
  if (!has_negative_) return {};
  SoftDirection soft;
  soft.found = true;
  soft.longest = std::sqrt(negative_.colwise().squaredNorm().maxCoeff());
  soft.slope = std::abs(dot(right_, negative_));
  soft.stiffness = curve.apply_stiffness(negative_, product_, scratch_);
  apply(curve, evaluator, true, negative_, product_);
  soft.curvature = dot(negative_, product_);
  return soft;
}

void KrylovSystem::soft_step(Nodes& step) const {
  step = negative_;
  if (dot(right_, negative_) < 0) step = -step;
}

void KrylovSystem::restrict_fields(const Curve& curve, Fields fields, Nodes& field) const {
  if (fields == Fields::all) return;
  for (Index e = 1; e < curve.num_elements(); ++e) field.col(e * curve.degree()).setZero();
}

// Legend, in the inner product of the preconditioner's inverse M: v = the Lanczos vector, u = M v its dual, alpha and
// beta the entries of the tridiagonal matrix T, whose eigenvalues approach those of P G A from inside.
KrylovSystem::Lowest KrylovSystem::lowest(const Curve& curve, Evaluator& evaluator, Fields fields, Nodes* direction) {
  const Index n = curve.num_nodes();
  const BandedCholesky& stiffness = fields == Fields::all ? stiffness_ : inside_;
  Nodes& u = residual_;
  Nodes& v = direction_;
  Nodes before(d_, n);
  Nodes next(d_, n);
  Lowest result;
  std::vector<double> alpha;
  std::vector<double> beta;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  // The second pass adds up the eigenvector from the same vectors again, which is cheaper than keeping them.
  for (int pass = 0; pass < (direction != nullptr ? 2 : 1); ++pass) {
    std::mt19937_64 random(20240611);  // the same numbers on every machine
    for (double& entry : u.reshaped()) entry = 2 * std::ldexp(static_cast<double>(random() >> 11), -53) - 1;
    project(u);
    restrict_fields(curve, fields, u);
    precondition(stiffness, u, v);
    if (direction != nullptr) {  // of several eigenvectors rather the one that leads down
      precondition(stiffness, right_, next);
      const double slope = dot(right_, next);
      if (slope > 0) {
        u += kDownhill * std::sqrt(dot(u, v) / slope) * right_;
        precondition(stiffness, u, v);
      }
    }
    // No field is free: nothing can be negative.
    double size = std::sqrt(dot(u, v));
    if (!(size > 0)) {
      result.value = 1;
      result.conclusive = true;
      return result;
    }
    u /= size;
    v /= size;
    before.setZero();
    double link = 0;
    const int most = pass == 0 ? kMostLanczosSteps : static_cast<int>(alpha.size());
    if (pass == 1) direction->setZero(d_, n);
    int next_look = kLeastLanczosSteps;
    for (int step = 0; step < most; ++step) {
      if (pass == 1) *direction += eigen.eigenvectors()(step, 0) * v;
      apply(curve, evaluator, true, v, product_);
      restrict_fields(curve, fields, product_);
      const double a = dot(v, product_);
      if (pass == 0) alpha.push_back(a);
      product_ -= a * u + link * before;
      project(product_);  // what is left may be small against the rounding of its parts
      precondition(stiffness, product_, next);
      const double square = dot(product_, next);
      link = std::sqrt(std::max(square, 0.0));
      const bool exhausted = !(link > kExhausted);
      if (pass == 0) {
        const auto size_now = static_cast<Index>(alpha.size());
        if (exhausted || step + 1 >= next_look || step + 1 == most) {
          next_look = step + 1 + (step + 1) / kLookEvery;
          eigen.computeFromTridiagonal(Eigen::Map<const Vector>(alpha.data(), size_now),
                                       Eigen::Map<const Vector>(beta.data(), size_now - 1));
          result.value = eigen.eigenvalues()(0);
          // The residual of the Ritz pair: an eigenvalue lies within it.
          const double error = link * std::abs(eigen.eigenvectors()(size_now - 1, 0));
          if (exhausted || error <= std::max(1e-3 * std::abs(result.value), 0.1 * kNeutral)) result.conclusive = true;
        }
        if (result.conclusive) break;
        beta.push_back(link);
      } else if (exhausted) {
        break;
      }
      before = u;
      u = product_ / link;
      v = next / link;
    }
  }
  double last = 1;
  for (const double value : eigen.eigenvalues()) {
    if (value >= -kNeutral) break;
    // Without reorthogonalisation Lanczos' method finds an eigenvalue again and again: copies count once.
    if (result.num_negative == 0 || value > last + 1e-6) ++result.num_negative;
    last = value;
  }
  return result;
}

Confirmation KrylovSystem::confirm_minimum(const Curve& curve, Evaluator& evaluator, double energy) {
  const Lowest found = lowest(curve, evaluator, Fields::all, nullptr);
  conclusive_ = found.conclusive;
  num_negative_ = found.num_negative;
  // Is every element alone positive definite? The mesh could not tell minima from saddles otherwise.
  if (num_negative_ == 0) resolved_ = lowest(curve, evaluator, Fields::within_elements, nullptr).value > 0;
  // Energy left = r . A^-1 r / 2 <= r . G r / (2 value), value the least eigenvalue of G A.
  if (found.value > kLeast) {
    const double most = 2 * found.value * energy;  // r . G r of a solution that leaves no more than this energy
    if (left_ > most && least_left_ > most) {
      least_left_ = most;
      return Confirmation::too_coarse;
    }
  }
  if (found.value > kLevel) return Confirmation::minimum;
  Nodes direction;
  (void)lowest(curve, evaluator, Fields::all, &direction);
  negative_ = std::move(direction);
  has_negative_ = true;
  return Confirmation::soft;
}

void KrylovSystem::bends(const Curve& curve, Evaluator& evaluator, const Nodes& step, Eigen::VectorXd& result) {
  const Points ones = Points::Ones(k_, curve.num_nodes());
  evaluator.hessian_times({.n = curve.num_nodes(), .x = curve.x.data(), .weight = ones.data()}, step.data(),
                          scaled_.data());
  result = step.cwiseProduct(scaled_).colwise().sum().cwiseAbs().transpose();
}

}  // namespace taut::detail
