// Parallel transport along shortest paths.
//
// Several parts of a way are carried one after the other, each along the geodesic that Newton's method makes of its
// path. On a surface in R^3 a geodesic's tangent v and n x v are carried parallel along it, so a vector's two
// components in that frame stay as they are: that serves any number of targets of a field.

#include "taut/query/tangent_maps.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "curve/polished.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

/// Orthonormal normals (d k x n) where the points are brought onto the surface.
Eigen::MatrixXd normals_near(const Surface& surface, const PointsIn& points) {
  Points on_surface = points;
  Eigen::MatrixXd normals;
  const std::unique_ptr<Evaluator> evaluator = surface.make_evaluator();
  (void)project_to_surface(*evaluator, surface.dim(), surface.codim(), on_surface, {}, &normals);
  return normals;
}

}  // namespace

TransportResult transport_along(PathSolver& solver, const PointsIn& stations, const PointsIn& vectors,
                                const Context& context) {
  const Surface& surface = solver.surface();
  const Index d = surface.dim();
  if (stations.rows() != d || stations.cols() < 2) {
    throw InvalidArgument(fmt::format("stations ({} x {}) to carry vectors along: must be {} x n, n >= 2",
                                      stations.rows(), stations.cols(), d));
  }
  if (vectors.rows() != d) {
    throw InvalidArgument(
        fmt::format("vectors have {} components, the surface lies in {} dimensions", vectors.rows(), d));
  }
  const Index parts = stations.cols() - 1;
  solver.expect(stations, parts);
  TransportResult result;
  result.end = vectors;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  bool settled = false;  // `start` is known
  for (Index i = 0; i < parts; ++i) {
    const PathResult path = solver.solve(stations.col(i), stations.col(i + 1));
    if (i == 0) result.from = path.from;
    result.to = path.to;
    result.length += path.length;
    result.unique = result.unique && path.unique;
    result.tied = result.tied || path.tied;
    const std::string part = parts > 1 ? fmt::format("part {} of {}: ", i + 1, parts) : "";
    if (!path.message.empty() && result.message.empty()) result.message = part + path.message;
    if (path.status != Status::ok) {
      result.status = path.status;
      result.message = part + path.message;
      break;
    }
    // Over an edge there is no one tangent plane; what carrying means there is a matter of convention.
    if (path.pieces.size() > 1) {
      result.status = Status::not_converged;
      result.message = part + "the path goes over edges, and vectors are carried on smooth faces only";
      break;
    }
    // A path of no length carries nothing anywhere; the vectors' tangential parts are taken by the next one.
    if (!(path.length > 0)) continue;
    const NewtonResult fine = detail::polished(surface, path.points, context);
    const CarriedVectors carried = parallel_transport(surface, fine.curve, result.end);
    if (carried.status != Status::ok) {
      result.status = carried.status;
      result.message = part + "the path runs into a point where the Jacobian of F loses rank";
      break;
    }
    if (!settled) result.start = carried.start;
    settled = true;
    result.end = carried.end;
    result.error += carried.error;
  }
  if (result.status != Status::ok) result.end.setConstant(kNaN);
  if (!settled) {  // nowhere to go: the tangential parts where they are
    const Eigen::MatrixXd normals = normals_near(surface, result.from);
    const Eigen::Map<const Eigen::MatrixXd> n(normals.data(), d, surface.codim());
    result.start = vectors - n * (n.transpose() * vectors);
    if (result.status == Status::ok) result.end = result.start;
  }
  return result;
}

Points transport_to_targets(const Surface& surface, const VectorIn& source, const PointsIn& targets,
                            const Distances& distances, const PointsIn& vectors) {
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument("vectors are carried to the targets of a field on surfaces in 3 dimensions only");
  }
  if (source.size() != 3 || vectors.rows() != 3 || targets.rows() != 3 || targets.cols() != distances.distance.size()) {
    throw InvalidArgument(
        "source, targets and vectors must have 3 coordinates, and the distances belong to the targets");
  }
  const Index m = vectors.cols();
  Points carried(3, targets.cols() * m);
  const Eigen::Vector3d n1 = normals_near(surface, source);
  const Eigen::MatrixXd n2 = normals_near(surface, targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    const Eigen::Vector3d v = distances.departure.col(j);
    const Eigen::Vector3d w = distances.arrival.col(j);
    if (distances.distance(j) == 0) {
      for (Index c = 0; c < m; ++c) carried.col(j * m + c) = vectors.col(c) - n1 * n1.dot(vectors.col(c));
      continue;
    }
    // (v, n x v) is carried to (w, n x w): parallel along the geodesic, for both keep their angle with its tangent.
    const Eigen::Vector3d across = n1.cross(v);
    const Eigen::Vector3d end_across = Eigen::Vector3d(n2.col(j)).cross(w);
    for (Index c = 0; c < m; ++c) {
      carried.col(j * m + c) = v.dot(vectors.col(c)) * w + across.dot(vectors.col(c)) * end_across;
    }
  }
  return carried;
}

}  // namespace taut
