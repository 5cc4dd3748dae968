#pragma once

#include <Eigen/Core>

#include "curve/gauss_collocation.hpp"
#include "curve/ray_field.hpp"
#include "taut/curve/spectral_curve.hpp"

namespace taut::detail {

/// A curve on a surface at the Gauss nodes of one step after the other: what linear equations along it need.
class CurveStages {
 public:
  static constexpr int kStages = GaussCollocation::kStages;
  using Field = RayField<Eigen::Dynamic>;

  explicit CurveStages(const Surface& surface) : field(surface, kStages) {}

  Field field;        ///< at the nodes of the last `look`
  Eigen::MatrixXd v;  ///< d x kStages: velocities there

  /// Of the curve's parameters t .. t + h, within one element. False where J loses rank or is not finite.
  [[nodiscard]] bool look(const SpectralCurve& curve, double t, double h) {
    const GaussCollocation& tables = GaussCollocation::tables();
    const Vector at = (t + h * tables.node.transpose().array()).matrix();
    x = curve.sample(at);
    v.resize(x.rows(), kStages);
    for (Index i = 0; i < kStages; ++i) v.col(i) = curve.velocity(at(i));
    return field.evaluate(kStages, x.data(), v.data()) == Field::Outcome::regular;
  }
  /// Of one point of it.
  [[nodiscard]] bool look_at(const SpectralCurve& curve, double t) {
    const Vector point = curve.point(t);
    const Vector velocity = curve.velocity(t);
    return field.evaluate(1, point.data(), velocity.data()) == Field::Outcome::regular;
  }

  Eigen::MatrixXd x;  ///< d x kStages: points there
};

/// Calls step(t, h) for `pieces` equal parts of every element in order, until one returns false. True when none did.
template <class Step>
[[nodiscard]] bool along_curve(const SpectralCurve& curve, int pieces, const Step& step) {
  double begin = 0;
  for (const double length : curve.lengths()) {
    const double h = length / pieces;
    for (int i = 0; i < pieces; ++i) {
      if (!step(begin + i * h, h)) return false;
    }
    begin += length;
  }
  return true;
}

/// Calls solve(pieces) with 1, 2, 4, ... pieces an element until two results differ by rounding, or as much as the two
/// before; it returns how far its result is from the one before. Returns the last difference.
template <class Solve>
double halve_until_settled(const Solve& solve) {
  // A jump of the normal inside an element, as at a crease, is not resolved by any number of pieces.
  constexpr int kMostPieces = 64;
  constexpr double kEnough = 4e-15;  // with order 16, halving a step that leaves this leaves nothing
  constexpr double kNoise = 1e-11;   // below, a difference that no longer shrinks is rounding
  double change = solve(1);
  double last = change;
  for (int pieces = 2; pieces <= kMostPieces; pieces *= 2) {
    last = change;
    change = solve(pieces);
    if (!(change > kEnough) || (pieces > 2 && change < kNoise && change > 0.5 * last)) break;
  }
  return change;
}

}  // namespace taut::detail
