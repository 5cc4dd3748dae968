#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "fan/exp_patch.hpp"
#include "fan/ray_strip.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Carries all rays of a strip one step further and turns what they swept into a patch.
/// Along each ray: x'' = -(v^T H v / |g|^2) g and the Jacobi field j'' + K j = 0, by Gauss collocation (order 2
/// kStages), solved by Picard iteration with the stages of all rays in one batch.
class StripStepper {
 public:
  explicit StripStepper(const Surface& surface);

  enum class Verdict : unsigned char {
    good,        // the figures below tell how good
    diverged,    // the iteration does not settle, or normals turn too far between nodes: too long, or too wide
    not_finite,  // F or a derivative is not finite, or its gradient is zero
  };

  // Of the last attempt, model units.
  double error_along = 0;   ///< of positions, left out by the series along the rays
  double error_across = 0;  ///< left out by the series across the rays
  double mismatch = 0;      ///< of d x / d alpha: what interpolation says against what the Jacobi fields say
  double off_along = 0;     ///< |F| / |g| at the nodes: of the step's length alone
  double off_surface = 0;   ///< between the nodes
  double width = 0;         ///< of the widest part
  bool inside = true;       ///< all nodes lie in the surface's domain
  bool gone = false;        ///< all rays end outside of it
  Index num_evaluated = 0;  ///< points, since the beginning

  /// The rays of source `x`, with n its unit normal and t a unit tangent, at arc length 0.
  [[nodiscard]] RayStrip start(const Eigen::Vector3d& x, const Eigen::Vector3d& n, const Eigen::Vector3d& t,
                               double angle, double half);
  /// The rays that leave a geodesic at right angles, at parameters middle - half .. middle + half, to its left seen
  /// from outside (side 1) or to its right (-1). The strip's "angle" is the parameter, with its sign changed on the
  /// left, so that Jacobi fields are positive on both sides.
  [[nodiscard]] RayStrip start_beside(const SpectralCurve& curve, double middle, double half, int side);
  /// Positions are sought to `tolerance`, model units.
  [[nodiscard]] Verdict attempt(const RayStrip& strip, double step, double tolerance);
  /// After a good attempt: the patch, and the strip at its end.
  [[nodiscard]] std::pair<PatchFrame, ExpPatch> patch(const RayStrip& strip) const;
  void arrive(RayStrip& strip) const;
  /// The lower and the upper half. False where F is not finite or has no gradient there.
  [[nodiscard]] bool split(const RayStrip& strip, RayStrip& lower, RayStrip& upper);

 private:
  static constexpr int kNodes = kRays * kStages;
  static constexpr int kChecks = 12;
  struct Sample {
    double value = 0;
    Eigen::Vector3d gradient;
    Eigen::Matrix3d hessian;
  };

  bool evaluate(Index n, const double* x);
  /// Of point i of the last visit.
  [[nodiscard]] Eigen::Vector3d acceleration(Index i, const Eigen::Vector3d& v) const;
  bool settle_ends(RayVectors& x, RayVectors& v, RayVectors& a, RayVectors& n);
  void place_nodes(const RayStrip& strip);
  void turn_by_hessians(const RayStrip& strip);
  void follow_fields(const RayStrip& strip);
  bool check(const RayStrip& strip);
  void look_at_domain();
  [[nodiscard]] bool goes_like_first_order(const RayStrip& strip, const PatchFrame& frame) const;

  std::unique_ptr<Evaluator> evaluator_;
  std::unique_ptr<Evaluator> domain_;  // null: the surface has no border
  Index domain_codim_ = 0;
  std::array<bool, kNodes> node_inside_{};
  std::vector<double> value_, gradient_, hessian_, weight_;
  double step_ = 0;
  RaySeries a_, x_, v_, normals_, visited_;
  Eigen::Array<double, kRays, kStages> curvature_;
  RayVectors end_x_, end_v_, end_a_, end_n_;
  RayNumbers end_jacobi_, end_slope_;
  Eigen::Array<double, kRays, kStages> fields_;
  Eigen::Matrix<double, 3 * kRays, kSeries> series_;
  double shift_ = 0;  // of the ends onto the surface
  // What of the errors is left in the panel's series, and at its end.
  double left_along_ = 0, left_across_ = 0, left_at_end_ = 0;
};

}  // namespace taut::detail
