#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/linear_algebra.hpp"
#include "curve/reference_element.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Parameter t of the first conjugate point of a geodesic whose pivots failed first at element end `failing`: it lies
/// in the element that begins there. Jacobi fields that vanish at the start solve the linearised equation A Y = 0
/// element by element: with S the condensed blocks of an element and Phi the flux that arrives from the left,
///   Phi + S_00 Y_0 + S_01 Y_1 = 0,   Phi' = S_10 Y_0 + S_11 Y_1.
/// A conjugate point is where a combination of the q fields vanishes. The chain of `system` is condensed with the
/// couplings to the ends of the curve.
template <class Curve, class System>
std::optional<double> find_conjugate_point(const Curve& curve, System& system, Index failing) {
  using Block = Eigen::MatrixXd;
  const Index q = system.tangents(0).cols();
  const int p = curve.degree();
  auto& chain = system.chain();

  Block here = Block::Zero(q, q);
  Block flux = Block::Identity(q, q);
  Block next = here;
  double t = 0;
  for (Index e = 0; e < failing; ++e) {
    const auto s = chain.end_block(e);
    const Block load = flux + s.topLeftCorner(q, q) * here;
    // S_01 is square, but not symmetric.
    next = -solve_square(s.topRightCorner(q, q), load);
    flux = (s.bottomLeftCorner(q, q) * here + s.bottomRightCorner(q, q) * next).eval();
    // Keep the fields independent: another basis of their span.
    // A flux is a slope: h makes it a length like Y itself.
    const double h = curve.lengths[static_cast<std::size_t>(e)];
    Block pairs(2 * q, q);
    pairs << next, h * flux;
    pairs = thin_qr(pairs).q;
    if (!pairs.allFinite()) return std::nullopt;
    here = pairs.topRows(q);
    flux = pairs.bottomRows(q) / h;
    t += h;
  }

  // The fields inside the element, as polynomials in R^d: column b of node i is T_i Y_i e_b.
  const auto s = chain.end_block(failing);
  next = -solve_square(s.topRightCorner(q, q), flux + s.topLeftCorner(q, q) * here);
  Eigen::MatrixXd nodal(q, curve.num_nodes());
  const Index d = curve.dim;
  Eigen::MatrixXd fields((p + 1) * d, q);  // rows of node i: i d ..
  for (Index b = 0; b < q; ++b) {
    nodal.col(failing * p) = here.col(b);
    nodal.col(failing * p + p) = next.col(b);
    chain.back_substitute(failing, nodal.data(), 0);
    for (int i = 0; i <= p; ++i) {
      fields.block(i * d, b, d, 1) = system.tangents(failing * p + i) * nodal.col(failing * p + i);
    }
  }
  const ReferenceElement& element = *curve.element;
  Eigen::VectorXd basis(p + 1);
  const auto combine = [&](const Eigen::VectorXd& coefficients) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(d, q);
    for (int i = 0; i <= p; ++i) sum += coefficients(i) * fields.middleRows(i * d, d);
    return sum;
  };
  // The combination of the fields that comes nearest to zero at xi, and the square of how near: an eigenvector of q x
  // q.
  const auto smallest = [&](double xi, Eigen::VectorXd& direction) {
    element.basis(xi, basis);
    const Eigen::MatrixXd field = combine(basis);
    const auto eigen = symmetric_eigen(Block(field.transpose() * field));
    direction = eigen.vectors.col(0);
    return eigen.values(0);
  };

  Eigen::VectorXd direction(q);
  double best = -1;
  double least = std::numeric_limits<double>::infinity();
  // The square of a distance may have several minima in an element: sampled first, then followed to the zero.
  constexpr int kSamples = 32;
  for (int i = 0; i <= kSamples; ++i) {
    const double xi = -1 + 2.0 * i / kSamples;
    const double value = smallest(xi, direction);
    if (value < least) {
      least = value;
      best = xi;
    }
  }
  for (int step = 0; step < 20; ++step) {  // Gauss-Newton for field(xi) direction = 0
    (void)smallest(best, direction);
    const Eigen::VectorXd value = combine(basis) * direction;
    const Eigen::VectorXd slope = combine(element.derivative.transpose() * basis) * direction;
    const double change = value.dot(slope) / slope.squaredNorm();
    if (!std::isfinite(change)) break;
    // Short steps stay in the valley that the samples found.
    best = std::clamp(best - std::clamp(change, -0.2, 0.2), -1.0, 1.0);
    if (std::abs(change) < 1e-13) break;
  }
  return t + curve.lengths[static_cast<std::size_t>(failing)] * (best + 1) / 2;
}

}  // namespace taut::detail
