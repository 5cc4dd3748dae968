// Inversion of a patch of the exponential map at a point q of the surface.
//
// With r = q - x(alpha, beta), e = x_alpha and t = x_beta, one Gauss-Newton step is (e.r / e.e, t.r / t.t): e.t = 0 by
// Gauss' lemma, so there is no system to solve. On a patch the map is nearly linear, and convergence is quadratic.
//
// Where neighbouring rays meet (near a conjugate point, or at the source) e tends to 0 and alpha is ill determined, but
// the distance is not: a miss `a` across the rays and the step da that would mend it change the distance by
// a (d m12 / ds) da half / 2 at most. So the iteration ends when that product is small, whichever factor is.
//
// Most of the way is gone on the first terms of the series alone, at a third of the time. Where the map is even
// (PatchFrame::even) they also tell that a point is not on the patch. Elsewhere they only give a better start: rays
// that draw near each other meet a point twice, and which of the two an iteration finds hangs on its way there.

#include "fan/exp_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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
/// A last step by this turns the direction of arrival by as many radians or so: then it is asked for anew.
constexpr double kTurned = 1e-11;

/// How the first terms of a series are used. Compared with the whole series from the same starts for 5 million pairs of
/// points and panels of eleven surfaces: at tolerances of 1e-9 and 1e-13 no distance was another one; on folded panels
/// of the ellipsoid 1:1:0.02 38 of 805,000 at 1e-6 (26 of them shorter) and one in a thousand at 1e-4.
struct SketchRule {
  int most_steps = 6;
  double most_off = 1e-4;  ///< of patch.sketch, panels' steps: coarser ones say too little
  double settled = 1e-2;   ///< a last step by this leaves its square, times `quadratic`
  double quadratic = 4;    ///< generous: where the map is even it bends less
  double slack = 2;        ///< of patch.sketch
};
constexpr SketchRule kSketch;

/// A solution on the first terms of a patch's series, and what it says of the point.
struct Sketch {
  enum class Verdict : unsigned char {
    off,    // it lies beside the patch
    near,   // here, or nearly
    blank,  // the iteration does not settle: nothing is said
  };
  Verdict verdict = Verdict::blank;
  double alpha = 0;
  double beta = 0;
};

/// A point of the patch at (alpha, beta) lies within `patch.sketch` of where its first terms put it, and so does their
/// solution within that, divided by how fast x goes.
Sketch sketch_of(const ExpPatch& patch, const Eigen::Vector3d& q, double alpha, double beta) {
  if (patch.sketch > kSketch.most_off * patch.step) return {};
  const double least = 1e-26 * patch.step * patch.step;
  for (int i = 0; i < kSketch.most_steps; ++i) {
    const PanelPoint p = panel_sketch(patch, alpha, beta);
    const Eigen::Vector3d r = q - p.x;
    const double ee = p.across.squaredNorm() + least;
    const double tt = p.along.squaredNorm();
    const double da = p.across.dot(r) / ee;
    const double db = p.along.dot(r) / tt;
    const bool settled = std::abs(da) < kSketch.settled && std::abs(db) < kSketch.settled;
    alpha += std::clamp(da, -0.7, 0.7);
    beta += std::clamp(db, -0.7, 0.7);
    if (settled) {
      const double left = kSketch.quadratic * (da * da + db * db);
      const double slack = kSketch.slack * patch.sketch;
      const bool off = std::abs(alpha) > 1 + patch.rim + left + slack / std::sqrt(ee) ||
                       std::abs(beta) > 1 + kRim + left + slack / std::sqrt(tt);
      return {off ? Sketch::Verdict::off : Sketch::Verdict::near, alpha, beta};
    }
    if (std::abs(alpha) > kAstray || std::abs(beta) > kAstray) break;
  }
  return {};
}

/// From (alpha, beta) on the whole series.
bool invert_from(const ExpPatch& patch, const Eigen::Vector3d& q, double alpha, double beta, PatchHit& hit) {
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
      const bool moved = std::abs(da) + std::abs(db) > kTurned;
      hit.arrival = (moved ? panel_point(patch, alpha + da, beta + db).along : p.along).normalized();
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

}  // namespace

bool invert(const ExpPatch& patch, const Eigen::Vector3d& q, double alpha, double beta, bool even, PatchHit& hit) {
  const Sketch sketch = sketch_of(patch, q, alpha, beta);
  if (sketch.verdict == Sketch::Verdict::off && even) return false;
  if (sketch.verdict == Sketch::Verdict::near && invert_from(patch, q, sketch.alpha, sketch.beta, hit)) return true;
  return invert_from(patch, q, alpha, beta, hit);
}

bool invert(const PatchFrame& frame, const ExpPatch& patch, const Eigen::Vector3d& q, PatchHit& hit) {
  if (!frame.bent) {
    const Eigen::Vector3d r = q - frame.centre;
    return invert(patch, q, std::clamp(r.dot(frame.across), -1.0, 1.0), std::clamp(r.dot(frame.along), -1.0, 1.0),
                  frame.even, hit);
  }
  // A caustic folds the panel: two geodesics of it, or more, may meet one point. Most starts lead to few of them.
  constexpr double kSame = 1e-4;  // of parameters: lengths differ by their square at a fold, and here not at all
  std::array<Sketch, 8> met;
  std::size_t count = 0;
  bool found = false;
  for (const double alpha : {-0.8, -0.3, 0.3, 0.8}) {
    for (const double beta : {-0.6, 0.6}) {
      Sketch start = sketch_of(patch, q, alpha, beta);
      if (start.verdict != Sketch::Verdict::near) start = {.alpha = alpha, .beta = beta};
      const auto same = [&](const Sketch& other) {
        return std::max(std::abs(other.alpha - start.alpha), std::abs(other.beta - start.beta)) < kSame;
      };
      if (std::any_of(met.begin(), met.begin() + static_cast<std::ptrdiff_t>(count), same)) continue;
      met[count++] = start;
      PatchHit other;
      const bool meets = invert_from(patch, q, start.alpha, start.beta, other) ||
                         (start.verdict == Sketch::Verdict::near && invert_from(patch, q, alpha, beta, other));
      if (!meets || (found && other.distance >= hit.distance)) continue;
      hit = other;
      found = true;
    }
  }
  return found;
}

}  // namespace taut::detail
