#include "walk/surface_walker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/normal_angle.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

/// A step that brings the target nearer by less than this part of its length is no progress.
constexpr double kLeastProgress = 0.02;
/// The last steps halve the distance, down to this part of a step; then the target must lie along the tangent space.
constexpr double kArrived = 1.0 / 16;
constexpr double kInSight = 0.8;
/// Squared sines of the angles between the tangent spaces at both ends of a step, together; steps over which they turn
/// by more, or the normals are mirrored (on the other side of a singular point), are halved, down to this part of a
/// step.
constexpr double kMostTurn = 0.35;
constexpr double kShortestStep = 1.0 / 64;
/// A walk between two points may be this many times longer than the straight line.
constexpr Index kMostDetour = 20;

}  // namespace

SurfaceWalker::SurfaceWalker(const Surface& surface, double step)
    : d_(surface.dim()), k_(surface.codim()), step_(step), evaluator_(surface.make_evaluator()) {}

bool SurfaceWalker::stand(const Vector& x, double reach, Foothold& result) {
  ++num_steps_;
  Points point = x;
  Eigen::MatrixXd normals;
  const bool found =
      project_to_surface(*evaluator_, d_, k_, point, ProjectionOptions{.max_distance = reach}, &normals)(0);
  if (found) {
    result.point = point.col(0);
    result.normals = normals.col(0);
  }
  return found;
}

Vector SurfaceWalker::tangent_part(const Foothold& at, Vector r) const {
  const Eigen::Map<const Eigen::MatrixXd> normals(at.normals.data(), d_, k_);
  r -= normals * (normals.transpose() * r);
  return r;
}

bool SurfaceWalker::turns(const Foothold& a, const Foothold& b) const {
  const Eigen::Map<const Eigen::MatrixXd> na(a.normals.data(), d_, k_);
  const Eigen::Map<const Eigen::MatrixXd> nb(b.normals.data(), d_, k_);
  return !(squared_sines(na, nb) <= kMostTurn && same_orientation(na, nb));
}

bool SurfaceWalker::walk(const Foothold& from, const Vector& target, Index most, std::vector<Foothold>& steps) {
  Foothold here = from;
  for (Index i = 0; i < most; ++i) {
    const Vector r = target - here.point;
    const double left = r.norm();
    const Vector t = tangent_part(here, r);
    if (left <= kArrived * step_) return t.norm() >= kInSight * left;
    if (t.norm() < kLeastProgress * left) return false;
    double step = left > 2 * step_ ? step_ : std::max(left / 2, 0.9 * kArrived * step_);
    const double shortest = std::min(step, kShortestStep * step_);
    Foothold next;
    // Where the surface turns too much over a step, as beside a singular point, it may have led to another sheet.
    while (!stand(here.point + step * t.normalized(), step, next) || turns(here, next)) {
      step /= 2;
      if (step < shortest) return false;
    }
    if ((target - next.point).norm() > left - kLeastProgress * step) return false;
    here = next;
    steps.push_back(std::move(next));
  }
  return false;
}

Points SurfaceWalker::walk(const Vector& p, const Vector& q) {
  Foothold start;
  std::vector<Foothold> steps;
  const auto most = kMostDetour * static_cast<Index>(std::ceil((q - p).norm() / step_) + 1);
  if (!stand(p, step_, start) || !walk(start, q, most, steps)) return Points(d_, 0);
  Points path(d_, static_cast<Index>(steps.size()) + 2);
  path.col(0) = p;
  for (std::size_t i = 0; i < steps.size(); ++i) path.col(static_cast<Index>(i) + 1) = steps[i].point;
  path.rightCols<1>() = q;
  return path;
}

}  // namespace taut::detail
