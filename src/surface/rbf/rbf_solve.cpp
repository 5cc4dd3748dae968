#include "surface/rbf/rbf_solve.hpp"

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/memory_limit.hpp"
#include "core/parallel.hpp"
#include "surface/rbf/cholesky.hpp"
#include "surface/rbf/kernel_sum.hpp"
#include "surface/rbf/polynomial.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

// The saddle system, with s = +1 for r^3 and -1 for r^5 (which are conditionally positive definite up to that sign):
//   (s Phi + ridge R) v + P c = f,   P^T v = 0,   weights = s v,
// R being 1 between constraints of the same sample. With P = Q [R1; 0], Q = [Q1 Q2], v = Q2 y:
//   (Q2^T G Q2) y = Q2^T f,   R1 c = Q1^T (f - G v).
class SaddleSystem {
 public:
  SaddleSystem(RbfKernel kernel, const Constraints& constraints, double ridge, const Context& context)
      : kernel_(kernel),
        constraints_(constraints),
        ridge_(ridge),
        context_(context),
        space_{constraints.at.rows(), kernel == RbfKernel::quintic ? 2 : 1} {
    eliminate_polynomial();
  }

  /// Assembles and factors Q2^T (G + jitter I) Q2. False when it is not positive definite in double precision.
  bool factor(double jitter) {
    assemble(jitter);
    reflect();
    const Index reduced = size() - space_.size();
    return cholesky_in_place(factor_.data() + space_.size() * (size() + 1), reduced, size(), context_) == reduced;
  }

  RbfSolution solve() {
    RbfSolution solution{Vector::Zero(size()), Vector::Zero(space_.size()), std::numeric_limits<double>::infinity()};
    Vector v = Vector::Zero(size());
    Vector residual = constraints_.value;
    constexpr int kMaxRefinements = 6;
    for (int step = 0; step <= kMaxRefinements; ++step) {
      const Vector dv = solve_reduced(residual);
      const Vector dc = solve_polynomial(residual - apply(dv));
      const Vector next_v = v + dv;
      const Vector next_c = solution.polynomial + dc;
      residual = constraints_.value - apply(next_v) - monomials_ * next_c;
      const double size_of_residual = residual.lpNorm<Eigen::Infinity>();
      if (!(size_of_residual < solution.residual)) break;
      const bool stagnates = size_of_residual > 0.5 * solution.residual;
      v = next_v;
      solution.polynomial = next_c;
      solution.residual = size_of_residual;
      if (stagnates || size_of_residual < 1e-14) break;
    }
    solution.weights = sign() * v;
    return solution;
  }

 private:
  [[nodiscard]] Index size() const { return constraints_.at.cols(); }
  [[nodiscard]] double sign() const { return kernel_ == RbfKernel::quintic ? -1.0 : 1.0; }

  void eliminate_polynomial() {
    const Index m = space_.size();
    monomials_.resize(size(), m);
    Vector row(m);
    for (Index i = 0; i < size(); ++i) {
      space_.evaluate(constraints_.at.col(i).data(), row.data());
      monomials_.row(i) = row.transpose();
    }
    if (size() >= m) {
      qr_.setThreshold(1e-9);
      qr_.compute(monomials_);
    }
    if (size() < m || qr_.rank() < m) {
      throw InvalidArgument("the points do not determine the polynomial part of the fit (" + std::to_string(m) +
                            " coefficients): they lie on a line, or too few of them differ");
    }
    // Q = I - V T V^T
    reflectors_ = qr_.matrixQR().triangularView<Eigen::UnitLower>();
    block_ = Eigen::MatrixXd::Zero(m, m);
    for (Index j = 0; j < m; ++j) {
      const double tau = qr_.hCoeffs()(j);
      block_(j, j) = tau;
      if (j == 0) continue;
      const Vector overlap = reflectors_.leftCols(j).transpose() * reflectors_.col(j);
      block_.col(j).head(j) = -tau * (block_.topLeftCorner(j, j) * overlap);
    }
  }

  void assemble(double jitter) {
    const Index n = size();
    const Index d = constraints_.at.rows();
    factor_.resize(n, n);
    parallel_for(context_, 0, n, 64, [&](Index first, Index last) {
      for (Index j = first; j < last; ++j) {
        const double* const at_j = constraints_.at.col(j).data();
        double* const column = factor_.col(j).data();
        for (Index i = j; i < n; ++i) {
          const double* const at_i = constraints_.at.col(i).data();
          double squared = 0;
          for (Index axis = 0; axis < d; ++axis) squared += (at_i[axis] - at_j[axis]) * (at_i[axis] - at_j[axis]);
          const double r = std::sqrt(squared);
          column[i] = kernel_ == RbfKernel::quintic ? -(squared * squared * r) : squared * r;
        }
        const Index owner = constraints_.sample[static_cast<std::size_t>(j)];
        for (Index i = j; i < n && constraints_.sample[static_cast<std::size_t>(i)] == owner; ++i) column[i] += ridge_;
        column[j] += jitter;
      }
    });
  }

  /// factor_ = Q^T factor_ Q, lower triangle, as G - V Y^T - Y V^T with Y = X T - V (T^T V^T X T) / 2, X = G V.
  void reflect() {
    const Eigen::MatrixXd x = factor_.selfadjointView<Eigen::Lower>() * reflectors_;
    const Eigen::MatrixXd xt = x * block_;
    const Eigen::MatrixXd core = block_.transpose() * (reflectors_.transpose() * xt);
    const Eigen::MatrixXd y = xt - 0.5 * (reflectors_ * core);
    const Index n = size();
    parallel_for(context_, 0, n, 64, [&](Index first, Index last) {
      for (Index j = first; j < last; ++j) {
        auto column = factor_.col(j).tail(n - j);
        column.noalias() -= reflectors_.bottomRows(n - j) * y.row(j).transpose();
        column.noalias() -= y.bottomRows(n - j) * reflectors_.row(j).transpose();
      }
    });
  }

  /// Q2 (Q2^T G Q2)^-1 Q2^T r
  Vector solve_reduced(const Vector& r) const {
    const Index m = space_.size();
    Vector rotated = qr_.householderQ().adjoint() * r;
    rotated.head(m).setZero();
    cholesky_solve(factor_.data() + m * (size() + 1), size() - m, size(), rotated.data() + m);
    return qr_.householderQ() * rotated;
  }

  /// R1^-1 Q1^T r
  Vector solve_polynomial(const Vector& r) const {
    const Index m = space_.size();
    const Vector rotated = qr_.householderQ().adjoint() * r;
    const Vector c = qr_.matrixR().topLeftCorner(m, m).triangularView<Eigen::Upper>().solve(rotated.head(m));
    return qr_.colsPermutation() * c;
  }

  /// G v, by the evaluator.
  Vector apply(const Vector& v) const {
    const KernelSum sum(kernel_, constraints_.at, sign() * v);
    const Index n = size();
    Vector result(n);
    parallel_for(context_, 0, n, 64, [&](Index first, Index last) {
      for (Index i = first; i < last; ++i) sum(constraints_.at.col(i).data(), &result(i), nullptr, nullptr);
    });
    for (Index i = 0; i < n;) {
      Index end = i;
      double total = 0;
      const Index owner = constraints_.sample[static_cast<std::size_t>(i)];
      for (; end < n && constraints_.sample[static_cast<std::size_t>(end)] == owner; ++end) total += v(end);
      for (; i < end; ++i) result(i) += ridge_ * total;
    }
    return result;
  }

  RbfKernel kernel_;
  const Constraints& constraints_;
  double ridge_;
  const Context& context_;
  PolynomialSpace space_;
  Eigen::MatrixXd monomials_;                       // P
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;  // of P
  Eigen::MatrixXd reflectors_;                      // V
  Eigen::MatrixXd block_;                           // T
  Eigen::MatrixXd factor_;
};

void require_memory(Index n, const Context& context) {
  constexpr double kVectors = 600;  // packed panels, reflectors, centres: columns of length n
  const double needed = 8 * static_cast<double>(n) * (static_cast<double>(n) + kVectors);
  const auto limit = static_cast<double>(memory_limit(context));
  if (needed <= limit) return;
  const auto megabytes = [](double bytes) { return std::to_string(static_cast<long>(bytes / (1 << 20))) + " MB"; };
  throw OutOfMemory("a fit with " + std::to_string(n) + " constraints needs " + megabytes(needed) + " of the " +
                    megabytes(limit) + " it may take: allow fewer samples (max_samples)");
}

}  // namespace

RbfSolution solve_rbf(RbfKernel kernel, const Constraints& constraints, double ridge, const Context& context) {
  require_memory(constraints.at.cols(), context);
  SaddleSystem system(kernel, constraints, ridge, context);
  // Kernels between almost coincident constraints differ by less than rounding: a little is added to the diagonal, and
  // refinement works against the system without it.
  const double unit = static_cast<double>(constraints.at.cols());
  for (const double jitter : {0.0, 1e-15, 1e-13, 1e-11}) {
    if (system.factor(jitter * unit)) return system.solve();
  }
  throw InvalidArgument("the fit is too badly conditioned for this kernel: the points are too unevenly spaced");
}

}  // namespace taut::detail
