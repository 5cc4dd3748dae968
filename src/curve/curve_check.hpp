#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "curve/reference_element.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// What a look between the nodes of a converged curve tells, at p + 2 Gauss points an element.
///
/// Two routes to the length: int |x'| of the polynomials, and the Lagrangian int |x'| + mu F along the whole curve, mu
/// = (x'' . g) / (|x'| |g|^2), which forgives a point off the surface to second order. Their difference is the
/// quadrature error of the constraint. What is left is quadratic in the curve's error: its normal part is seen
/// directly, n . x', its tangential part through the residual P x'' (an element's lowest free mode answers it with (h /
/// 2)^2 / (p (p + 1))). The energy, sqrt(2 T E), would add what the speed varies by: 1e-8 where elements of 1e-5 at a
/// sharp rim hold up the parameter.
struct CurveCheck {
  double length = 0;        ///< from the Lagrangian, model units
  double length_error = 0;  ///< model units
  double off_surface = 0;   ///< max |J^+ F|
  double geodesic_curvature = 0;
  double curvature = 0;  ///< sup |x''|: to judge the residual by
  double corner = 0;     ///< largest jump of the unit tangent from element to element: a crease, once converged
  double turning = 0;    ///< int |k_g| ds and the jumps: how much the curve bends within the surface, radians
  bool regular = true;   ///< J has full rank, F is finite at every check point
  /// Least over largest own gradient (of any equation: what of grad F_i the others before it do not span) along the
  /// curve; nearly zero close to a singular point.
  double weakest_gradient = 0;
  std::vector<double> element_error;   ///< length error made in each element
  std::vector<double> element_corner;  ///< largest jump at the ends of each element
  std::vector<double> element_off;     ///< max |J^+ F| in each element
  /// Elements in which an own gradient dips so sharply that the check points do not show how deep: a singular point is
  /// near, at less than their distance. Geodesics may pass it without a bend (a double cone holds straight lines).
  std::vector<bool> element_dips;
};

template <class Frame>
class CurveChecker {
 public:
  static constexpr int D = Frame::kD;
  static constexpr int K = Frame::kK;
  static constexpr double kCorner = 0.1;  // radians
  /// On a surface of limited smoothness (|x|^3, a blend) the error between nodes is seen in part only; measured.
  static constexpr double kRoughness = 5;

  using VectorD = Eigen::Matrix<double, D, 1>;
  using VectorK = Eigen::Matrix<double, K, 1>;

  CurveChecker(Index dim, Index codim) : d_(dim), k_(codim) {
    frame_.resize(dim, codim);
    scratch_.resize(codim);
    for (VectorD* v : {&first_, &second_, &step_, &tangential_}) v->resize(dim);
    modes_.resize(dim, 4);
  }

  [[nodiscard]] Index num_evaluated() const { return evaluated_; }
  void reset_counters() { evaluated_ = 0; }

  /// `check` is reused from call to call.
  template <class Kernel>
  void inspect(Evaluator& evaluator, const Kernel& kernel, CurveCheck& check) {
    const ReferenceElement& element = kernel.element();
    const int n = element.num_nodes();
    const int checks = element.num_checks();
    const Index m = kernel.num_elements();
    const auto& x = kernel.nodes();
    local_.resize(d_, n);
    points_.resize(d_, m * checks);
    firsts_.resize(d_, m * checks);
    seconds_.resize(d_, m * checks);
    value_.resize(k_, m * checks);
    jacobian_.resize(d_ * k_, m * checks);
    // Zero stays where J has no full rank: the weakest gradient there.
    own_gradient_.setZero(k_, m * checks);
    for (Index e = 0; e < m; ++e) {
      const double scale = 2 / kernel.lengths()[static_cast<std::size_t>(e)];
      // Relative to the element's first node: large coordinates would cost the derivatives their digits.
      local_ = x.middleCols(e * kernel.degree(), n).colwise() - x.col(e * kernel.degree());
      points_.middleCols(e * checks, checks).noalias() = local_.lazyProduct(element.check_value);
      points_.middleCols(e * checks, checks).colwise() += x.col(e * kernel.degree());
      firsts_.middleCols(e * checks, checks).noalias() = local_.lazyProduct(scale * element.check_first);
      seconds_.middleCols(e * checks, checks).noalias() = local_.lazyProduct((scale * scale) * element.check_second);
    }
    const int p = kernel.degree();
    jump_.resize(d_, m);
    jump_.col(0).setZero();
    for (Index e = 0; e < m; ++e) {  // x' at both ends of element e
      const double scale = 2 / kernel.lengths()[static_cast<std::size_t>(e)];
      local_ = x.middleCols(e * p, n).colwise() - x.col(e * p);
      if (e > 0) jump_.col(e).noalias() += scale * local_.lazyProduct(element.derivative.row(0).transpose());
      if (e + 1 < m) jump_.col(e + 1).noalias() = -scale * local_.lazyProduct(element.derivative.row(p).transpose());
    }
    evaluated_ += m * checks;
    evaluator.evaluate({.n = m * checks, .x = points_.data(), .value = value_.data(), .jacobian = jacobian_.data()});
    gather(kernel, check);
  }

 private:
  /// Do the last Legendre coefficients of x'' (d x p + 2) over an element fall, as those of an analytic curve that is
  /// resolved do.
  [[nodiscard]] bool is_smooth(const ReferenceElement& element, const Eigen::Ref<const Eigen::MatrixXd>& seconds) {
    constexpr double kFall = 0.25;
    // Lower degrees have too few modes to see them fall.
    if (element.degree < 5) return true;
    modes_.noalias() = seconds * element.check_modes;
    // In pairs, since even or odd modes alone may vanish by symmetry.
    const double before = std::max(modes_.col(0).norm(), modes_.col(1).norm());
    return std::max(modes_.col(2).norm(), modes_.col(3).norm()) <= kFall * before;
  }

  template <class Kernel>
  void gather(const Kernel& kernel, CurveCheck& check) {
    const ReferenceElement& element = kernel.element();
    const int checks = element.num_checks();
    const int p = kernel.degree();
    const Index m = kernel.num_elements();
    check.element_error.assign(static_cast<std::size_t>(m), 0.0);
    check.element_off.assign(static_cast<std::size_t>(m), 0.0);
    check.element_dips.assign(static_cast<std::size_t>(m), false);
    check.regular = true;
    check.element_corner.assign(static_cast<std::size_t>(m), 0.0);
    check.off_surface = check.geodesic_curvature = check.curvature = check.corner = check.turning = 0;
    double length = 0;       // int |x'|
    double correction = 0;   // int mu F
    double corrections = 0;  // the same of each element without its sign: what the quadrature knows it by
    double remainder = 0;    // quadratic in the error
    const double to_length = kernel.length() > 0 ? kernel.period() / kernel.length() : 1;  // dL = dE / speed
    for (Index e = 0; e < m; ++e) {
      const double half = kernel.lengths()[static_cast<std::size_t>(e)] / 2;
      // To P x'' = r an element answers with its lowest free mode, of stiffness p (p + 1) / half^2.
      const double response = half * half / (p * (p + 1));
      double element_remainder = 0;
      double element_correction = 0;
      // A kink between elements is part of the residual; a large one is a corner, which the path may yet slide along.
      const double bend = jump_.col(e).squaredNorm();
      element_remainder += response / half * bend / 2;
      if (bend > kCorner * kCorner) element_remainder += half * bend / 4;
      const double kink = std::sqrt(bend);
      check.element_corner[static_cast<std::size_t>(e)] = kink;
      if (e > 0) {
        double& before = check.element_corner[static_cast<std::size_t>(e - 1)];
        before = std::max(before, kink);
      }
      check.turning += kink;
      check.corner = std::max(check.corner, kink);
      double& off = check.element_off[static_cast<std::size_t>(e)];
      for (int g = 0; g < checks; ++g) {
        const Index j = e * checks + g;
        const double weight = half * element.check_weight(g);
        Eigen::Map<const Eigen::Matrix<double, D, K>> gradients(jacobian_.col(j).data(), d_, k_);
        first_ = firsts_.col(j);
        second_ = seconds_.col(j);
        const double speed = first_.norm();
        length += weight * speed;
        if (!value_.col(j).allFinite() || !frame_.compute(gradients)) {
          check.regular = false;
          continue;
        }
        for (Index i = 0; i < k_; ++i) own_gradient_(i, j) = frame_.own_gradient(i);
        frame_.pseudo_inverse(value_.col(j), scratch_, step_);  // J^+ F
        off = std::max(off, step_.norm());
        if (speed > 0) element_correction += weight * second_.dot(step_) / speed;
        const double normal_speed = (frame_.normals().transpose() * first_).squaredNorm();
        tangential_ = second_ - frame_.normals() * (frame_.normals().transpose() * second_);
        element_remainder += weight * (normal_speed + response * tangential_.squaredNorm()) / 2;
        // The parameter is arc length to the order of the error only.
        const double squared_speed = first_.squaredNorm();
        check.curvature = std::max(check.curvature, second_.norm() / squared_speed);
        tangential_ -= first_ * (tangential_.dot(first_) / squared_speed);
        const double bending = tangential_.norm() / squared_speed;
        check.geodesic_curvature = std::max(check.geodesic_curvature, bending);
        check.turning += weight * bending * speed;
      }
      element_remainder *= to_length;
      const double caution = is_smooth(element, seconds_.middleCols(e * checks, checks)) ? 1 : kRoughness;
      element_remainder *= caution;
      check.off_surface = std::max(check.off_surface, off);
      correction += element_correction;
      corrections += caution * std::abs(element_correction);
      remainder += element_remainder;
      check.element_error[static_cast<std::size_t>(e)] = element_remainder + caution * std::abs(element_correction);
    }
    check.length = std::max(length + correction, 0.0);
    check.length_error = remainder + corrections;
    find_dips(kernel, check);
  }

  /// Weakest gradient, and where it may fall to zero between check points: where the lines through two of them on
  /// either side meet far below what was seen. For |s| they meet at 0, for a dip that is resolved near its bottom.
  template <class Kernel>
  void find_dips(const Kernel& kernel, CurveCheck& check) {
    constexpr double kWeak = 0.05;
    constexpr double kBelow = 0.3;
    const int checks = kernel.element().num_checks();
    place_.resize(own_gradient_.cols());
    double left = 0;
    for (Index e = 0; e < kernel.num_elements(); ++e) {
      const double h = kernel.lengths()[static_cast<std::size_t>(e)];
      for (int g = 0; g < checks; ++g) place_(e * checks + g) = left + h * (1 + kernel.element().check_node(g)) / 2;
      left += h;
    }
    check.weakest_gradient = 1;
    for (Index i = 0; i < k_; ++i) {
      const auto own = own_gradient_.row(i);
      const double strongest = own.maxCoeff();
      if (!(strongest > 0)) {
        check.weakest_gradient = 0;
        return;
      }
      check.weakest_gradient = std::min(check.weakest_gradient, own.minCoeff() / strongest);
      for (Index j = 1; j + 2 < own.size(); ++j) {
        // Only where it is weak already can a zero lie between two check points.
        const double less = std::min(own(j), own(j + 1));
        if (less > kWeak * strongest) continue;
        const double falls = (own(j - 1) - own(j)) / (place_(j) - place_(j - 1));
        const double rises = (own(j + 2) - own(j + 1)) / (place_(j + 2) - place_(j + 1));
        if (!(falls > 0 && rises > 0)) continue;
        const double gap = place_(j + 1) - place_(j);
        const double bottom = (own(j) * rises + own(j + 1) * falls - gap * falls * rises) / (falls + rises);
        if (bottom >= kBelow * less) continue;
        for (const Index near : {j, j + 1}) check.element_dips[static_cast<std::size_t>(near / checks)] = true;
      }
    }
  }

  Index d_;
  Index k_;
  Frame frame_;
  VectorK scratch_;
  VectorD first_, second_, step_, tangential_;
  Eigen::Matrix<double, D, Eigen::Dynamic> local_, points_, firsts_, seconds_, jump_;
  Eigen::Matrix<double, K, Eigen::Dynamic> value_;
  Eigen::MatrixXd jacobian_;
  Eigen::Matrix<double, D, 4> modes_;
  Eigen::MatrixXd own_gradient_;  // k x check points
  Eigen::VectorXd place_;         // parameter of the check points
  Index evaluated_ = 0;
};

}  // namespace taut::detail
