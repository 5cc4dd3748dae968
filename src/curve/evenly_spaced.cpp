// Points at equal distances along a dense curve (d x m) on a surface. Arc lengths: each chord is taken for that of a
// circle whose curvature is the mean of its ends', which takes away the leading error of chords. Corners turn by more
// than kCorner and have no curvature. The points themselves are interpolated on the chords and projected.
#include "taut/curve/spectral_curve.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr double kCorner = 0.3;  // radians between chords: on curves as Taut samples them only true corners turn more

/// Curvature at point i of the curve from the chords on both sides; 0 at a corner and at the ends.
double curvature(const PointsIn& curve, Index i) {
  if (i == 0 || i + 1 == curve.cols()) return 0;
  const Vector before = curve.col(i) - curve.col(i - 1);
  const Vector after = curve.col(i + 1) - curve.col(i);
  const double a = before.norm();
  const double b = after.norm();
  if (!(a > 0) || !(b > 0)) return 0;
  // By the sine of half the angle: the cosine of a small one is 1 to rounding.
  const double angle = 2 * std::asin(std::min(1.0, (before / a - after / b).norm() / 2));
  return angle > kCorner ? 0 : 2 * angle / (a + b);
}

}  // namespace

Vector arc_lengths(const PointsIn& curve) {
  const Index m = curve.cols();
  Vector lengths = Vector::Zero(m);
  double here = curvature(curve, 0);
  for (Index i = 0; i + 1 < m; ++i) {
    const double next = curvature(curve, i + 1);
    const double chord = (curve.col(i + 1) - curve.col(i)).norm();
    // An end knows no curvature of its own and takes its neighbour's.
    const double known = (here > 0 && next > 0) ? (here + next) / 2 : std::max(here, next);
    const double half_angle = known * chord / 2;
    const double stretch = half_angle > 0 ? half_angle / std::sin(half_angle) : 1;
    lengths(i + 1) = lengths(i) + stretch * chord;
    here = next;
  }
  return lengths;
}

Points evenly_spaced(const Surface& surface, const PointsIn& curve, Index n) {
  if (n < 2) throw InvalidArgument("evenly_spaced: " + std::to_string(n) + " points; give two at least");
  if (curve.cols() < 2 || curve.rows() != surface.dim()) {
    throw InvalidArgument("evenly_spaced: a curve of " + std::to_string(curve.rows()) + " x " +
                          std::to_string(curve.cols()) + "; it must be " + std::to_string(surface.dim()) +
                          " x m, m at least 2");
  }
  const Vector lengths = arc_lengths(curve);
  const Index last = curve.cols() - 1;
  Points points(curve.rows(), n);
  Index i = 0;  // the segment that holds the point
  for (Index j = 0; j < n; ++j) {
    const double s = lengths(last) * static_cast<double>(j) / static_cast<double>(n - 1);
    // Both ascend: one pass for all points.
    while (i + 1 < last && lengths(i + 1) <= s) ++i;
    const double segment = lengths(i + 1) - lengths(i);
    const double t = segment > 0 ? std::clamp((s - lengths(i)) / segment, 0.0, 1.0) : 0;
    points.col(j) = (1 - t) * curve.col(i) + t * curve.col(i + 1);
  }
  project_to_surface(*surface.function().make_evaluator(), surface.dim(), surface.codim(), points);
  // The ends are those of the curve, bit for bit.
  points.col(0) = curve.col(0);
  points.col(n - 1) = curve.col(last);
  return points;
}

}  // namespace taut
