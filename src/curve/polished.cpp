// End directions of a geodesic between two points, by shooting.
//
// Notation: E a frame of the directions across the geodesic, E0 at its start, E1 the same carried parallel to its end.
// A ray that leaves along v + E0 delta ends at q + E1 J delta, J the Jacobi fields that start with slope one: m12 on a
// 2-surface, else about the length, which Broyden's updates make better from ray to ray.

#include "curve/polished.hpp"

#include <cmath>
#include <memory>

#include "core/check_tolerance.hpp"
#include "core/linear_algebra.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

/// Directions across more than this are not corrected: frames of so many take longer than the path.
constexpr Index kMostAcross = 64;

/// d x k: orthonormal normals at x.
Eigen::MatrixXd normals_at(const Surface& surface, const Vector& x) {
  Points at = x;
  Eigen::MatrixXd normals;
  const std::unique_ptr<Evaluator> evaluator = surface.make_evaluator();
  (void)project_to_surface(*evaluator, surface.dim(), surface.codim(), at, {}, &normals);
  return Eigen::Map<const Eigen::MatrixXd>(normals.data(), surface.dim(), surface.codim());
}

/// d x q: unit tangents that stand at a right angle to the tangent v.
Eigen::MatrixXd frame_across(const Eigen::MatrixXd& normals, const Vector& v) {
  const Index d = normals.rows();
  const Index k = normals.cols();
  Eigen::MatrixXd known(d, k + 1);
  known << normals, v;
  return orthogonal_complement(known);
}

/// About how far a ray ends beside another one, to the angle between them: m12 on a 2-surface, else the length.
double spread(const Surface& surface, const Vector& from, const Vector& v, double length) {
  if (surface.dim() - surface.codim() != 2) return length;
  const GeodesicScales scales = geodesic_scales(surface, from, v, length);
  return scales.status == Status::ok && std::abs(scales.m12) > 1e-8 * length ? scales.m12 : length;
}

}  // namespace

NewtonResult polished(const Surface& surface, const PointsIn& points, const Context& context) {
  return correct_newton(surface, points, {.tolerance = kLeastTolerance, .leave_saddles = false}, context);
}

EndDirections end_directions(const Surface& surface, const NewtonResult& geodesic, const Context& context) {
  const SpectralCurve& curve = geodesic.curve;
  EndDirections best{curve.velocity(0).normalized(), curve.velocity(curve.period()).normalized()};
  const Vector from = geodesic.points.col(0);
  const Vector to = geodesic.points.col(geodesic.points.cols() - 1);
  const Index across = surface.dim() - surface.codim() - 1;
  try {
    ExponentialMap rays(surface, {.conjugate = false, .points = false});
    const Eigen::MatrixXd normals = normals_at(surface, from);
    // The curve's end tangents are tangent to the surface only as far as the curve is exact.
    best.departure = (best.departure - normals * (normals.transpose() * best.departure)).normalized();
    Vector v = best.departure;
    Eigen::MatrixXd start;
    Eigen::MatrixXd end;
    Eigen::MatrixXd inverse;  // of J
    Vector last_step;
    Vector last_off;
    constexpr int kMostRays = 12;
    for (int ray = 0; ray < kMostRays; ++ray) {
      const ExponentialResult landed = rays.trace(from, v, geodesic.length, context);
      if (landed.status != Status::ok) break;
      const Vector missed = landed.point - to;
      const double miss = missed.norm();
      // Better by a little only: rounding is all that is left.
      const bool settled = ray > 0 && !(miss < 0.5 * best.miss);
      if (ray == 0 || miss < best.miss) best = {v, landed.direction, miss};
      // On a curve (n = 1) there is one direction, and it was right or wrong from the start.
      if (settled || across == 0 || across > kMostAcross) break;
      if (ray == 0) {
        start = frame_across(normals, v);
        end = parallel_transport(surface, curve, start).end;
        inverse = Eigen::MatrixXd::Identity(across, across) / spread(surface, from, v, geodesic.length);
      }
      // What is missed along the ray is its length's matter; only what is across can be aimed at.
      const Vector off = end.transpose() * missed;
      if (ray > 0) {  // Broyden's update: `inverse` takes what the last step changed to that step
        const Vector change = off - last_off;
        const Vector mapped = inverse * change;
        const double size = last_step.dot(mapped);
        if (size != 0) inverse += (last_step - mapped) * (last_step.transpose() * inverse) / size;
      }
      last_step = -(inverse * off);
      last_off = off;
      v = (v + start * last_step).normalized();
    }
  } catch (const SingularPoint&) {  // then the curve's own tangents stand
  }
  return best;
}

}  // namespace taut::detail
