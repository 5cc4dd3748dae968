// Inversion of a patch of the exponential map at a point q of the surface.
//
// With r = q - x(alpha, beta), e = x_alpha and t = x_beta, one Gauss-Newton step is (e.r / e.e, t.r / t.t): e.t = 0 by
// Gauss' lemma, so there is no system to solve. On a patch the map is nearly linear, and convergence is quadratic.
//
// Where neighbouring rays meet (near a conjugate point, or at the source) e tends to 0 and alpha is ill determined, but
// the distance is not: a miss `a` across the rays and the step da that would mend it change the distance by
// a (d m12 / ds) da half / 2 at most. So the iteration ends when that product is small, whichever factor is.

#include "fan/exp_patch.hpp"

#include <algorithm>
#include <cmath>

#include "fan/panel_point.hpp"

namespace taut::detail {
namespace {

/// Parameters this far outside count as inside: neighbours' rounding must leave no gap.
constexpr double kRim = 1e-3;
/// Beyond this an iterate has left for good; a panel's series mean nothing there.
constexpr double kAstray = 1.6;
constexpr int kMostSteps = 40;
/// Steps after which an iterate that does not converge quickly is given up, unless rays meet there.
constexpr int kQuickSteps = 8;
/// What an unfinished iteration may do to the distance, in units of the panel's step. Rounding is 1e-16 or so.
constexpr double kEnough = 1e-13;
/// A last step along the ray by this leaves its square, in units of the panel.
constexpr double kClose = 1e-5;

}  // namespace

bool invert(const ExpPatch& patch, const Eigen::Vector3d& q, double alpha, double beta, PatchHit& hit) {
  const double half_step = patch.step / 2;
  for (int i = 0; i < kMostSteps; ++i) {
    const PanelPoint p = panel_point(patch, alpha, beta);
    const Eigen::Vector3d r = q - p.x;
    const double ee = p.across.squaredNorm();
    const double tt = p.along.squaredNorm();
    const double er = p.across.dot(r);
    // Rays that meet to rounding do not tell alpha; then it may stay where it is.
    const double least = 1e-26 * half_step * half_step;
    double da = er / (ee + least);
    const double db = p.along.dot(r) / tt;
    const double miss_across = std::abs(er) / std::sqrt(ee + least);
    if (miss_across * std::abs(da) <= kEnough * patch.step && std::abs(db) < kClose) {
      if (std::abs(alpha + da) > 1 + patch.rim || std::abs(beta + db) > 1 + kRim) return false;
      double length = patch.length + half_step * (beta + db + 1);
      if (length < 0) {
        // At a source it is the ray the other way. On a curve rounding decides to which side a point belongs.
        if (!patch.beside_curve || length < -kEnough * patch.step) return false;
        length = 0;
      }
      // What is left must be rounding off the surface, not a point that the fold of a caustic keeps out of reach.
      const Eigen::Vector3d rest = r - db * p.along - da * p.across;
      const double allowed = 1e-9 * patch.step + 10 * patch.error;
      if (rest.norm() > allowed) return false;
      hit.distance = patch.value + length;
      hit.angle = patch.angle + patch.half * (alpha + da);
      hit.arrival = p.along / std::sqrt(tt);
      hit.error = patch.error;
      return true;
    }
    da = std::clamp(da, -0.7, 0.7);
    alpha += da;
    beta += std::clamp(db, -0.7, 0.7);
    if (std::abs(alpha) > kAstray || std::abs(beta) > kAstray) return false;
    if (i >= kQuickSteps && ee > 1e-4 * half_step * half_step) return false;
  }
  return false;
}

bool invert(const PatchFrame& frame, const ExpPatch& patch, const Eigen::Vector3d& q, PatchHit& hit) {
  if (!frame.bent) {
    const Eigen::Vector3d r = q - frame.centre;
    return invert(patch, q, std::clamp(r.dot(frame.across), -1.0, 1.0), std::clamp(r.dot(frame.along), -1.0, 1.0), hit);
  }
  // A caustic folds the panel: two geodesics of it, or more, may meet one point.
  bool found = false;
  for (const double alpha : {-0.8, -0.3, 0.3, 0.8}) {
    for (const double beta : {-0.6, 0.6}) {
      PatchHit other;
      if (!invert(patch, q, alpha, beta, other) || (found && other.distance >= hit.distance)) continue;
      hit = other;
      found = true;
    }
  }
  return found;
}

}  // namespace taut::detail
