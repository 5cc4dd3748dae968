// The arc of a chain on a face: Newton's method between fixed ends, and the Jacobi fields j'' + K j = 0 along what it
// finds, K = g . adj(H) g / |g|^4 the curvature of the face.
#include "strata/face_arc.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check_tolerance.hpp"
#include "curve/polyline.hpp"
#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

/// Nodes of a polyline that a geodesic starts from.
constexpr Index kMostStart = 24;
/// The fields' steps: their ends to 1e-6 or so are all that Newton's method for the stops wants.
constexpr int kSteps = 32;

void set_straight(const Point3& a, const Point3& b, ChainArc& arc) {
  arc.length = (b - a).norm();
  arc.first = arc.last = arc.length > 0 ? Point3((b - a) / arc.length) : Point3::Zero();
  arc.points = chord(a, b);
  arc.m12 = std::max(arc.length, 1e-300);
  arc.m = arc.slope = 1;
  arc.shortest = true;
  arc.index = 0;
  arc.line.resize(3, 0);
}

void set_fields(SmoothFace& face, const SpectralCurve& curve, ChainArc& arc) {
  // By Runge and Kutta.
  Vector t = Vector::LinSpaced(2 * kSteps + 1, 0, curve.period());
  const Points x = curve.sample(t);
  Points value(1, x.cols());
  Points jacobian(3, x.cols());
  Points hessian(9, x.cols());
  const Points weight = Points::Ones(1, x.cols());
  jacobian.setZero();
  hessian.setZero();
  face.evaluator->evaluate({.n = x.cols(),
                            .x = x.data(),
                            .value = value.data(),
                            .jacobian = jacobian.data(),
                            .weight = weight.data(),
                            .hessian = hessian.data()});
  std::vector<double> curvature(static_cast<std::size_t>(x.cols()));
  for (Index i = 0; i < x.cols(); ++i) {
    const Point3 g = jacobian.col(i);
    const Eigen::Matrix3d h = Eigen::Map<const Eigen::Matrix3d>(hessian.col(i).data());
    Eigen::Matrix3d adjugate;
    adjugate.col(0) = Point3(h.row(1)).cross(Point3(h.row(2)));
    adjugate.col(1) = Point3(h.row(2)).cross(Point3(h.row(0)));
    adjugate.col(2) = Point3(h.row(0)).cross(Point3(h.row(1)));
    const double g2 = g.squaredNorm();
    curvature[static_cast<std::size_t>(i)] = g.dot(adjugate * g) / (g2 * g2);
  }
  Eigen::Vector2d field(0, 1);   // m12 and its slope
  Eigen::Vector2d field2(1, 0);  // M12
  const double h = arc.length / kSteps;
  const auto step = [&](Eigen::Vector2d& y, std::size_t i) {
    const auto slope = [&](const Eigen::Vector2d& v, double k) { return Eigen::Vector2d(v.y(), -k * v.x()); };
    const Eigen::Vector2d k1 = slope(y, curvature[i]);
    const Eigen::Vector2d k2 = slope(y + h / 2 * k1, curvature[i + 1]);
    const Eigen::Vector2d k3 = slope(y + h / 2 * k2, curvature[i + 1]);
    const Eigen::Vector2d k4 = slope(y + h * k3, curvature[i + 2]);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  };
  arc.index = 0;
  for (std::size_t i = 0; i < 2 * kSteps; i += 2) {
    const double before = field.x();
    step(field, i);
    step(field2, i);
    if (i > 0 && (before > 0) != (field.x() > 0)) ++arc.index;
  }
  arc.line = x;
  arc.m12 = field.x();
  arc.slope = field.y();
  arc.m = field2.x();
}

}  // namespace

bool trace_face_arc(FacetedSurface& surface, ChainArc& arc, const Point3& a, const Point3& b, const Context& context) {
  SmoothFace& face = surface.face(arc.face);
  if (face.flat) {
    set_straight(a, b, arc);
    return true;
  }
  if (!face.solver)
    face.solver.emplace(face.surface, NewtonOptions{.tolerance = kLeastTolerance, .leave_saddles = false});
  if ((b - a).norm() <= ChainTolerances::together * surface.scale) {
    set_straight(a, b, arc);
    return true;
  }
  // The curve it had, its ends moved.
  Points start = arc.start.cols() >= 2 ? arc.start : Points(chord(a, b));
  if (start.cols() > kMostStart) start = at_equal_parts(start, kMostStart);
  const Point3 first = a - Point3(start.col(0));
  const Point3 last = b - Point3(start.col(start.cols() - 1));
  const auto parts = static_cast<double>(start.cols() - 1);
  for (Index i = 0; i < start.cols(); ++i) {
    const double u = static_cast<double>(i) / parts;
    start.col(i) += (1 - u) * first + u * last;
  }
  start.col(0) = a;
  start.col(start.cols() - 1) = b;
  NewtonResult found = face.solver->solve(start, context);
  if (found.status != Status::ok || found.curve.num_elements() == 0) return false;
  arc.length = found.length;
  arc.error = found.length_error;
  arc.points = found.points;
  arc.start = found.points;
  const double period = found.curve.period();
  arc.first = Point3(found.curve.velocity(0)).normalized();
  arc.last = Point3(found.curve.velocity(period)).normalized();
  arc.shortest = found.locally_shortest;
  arc.residual = found.residual;
  arc.iterations = found.num_iterations;
  set_fields(face, found.curve, arc);
  return std::isfinite(arc.m12) && std::isfinite(arc.m) && arc.m12 != 0;
}

}  // namespace taut::detail
