// The log map: the shortest path, corrected again as far as rounding allows, told by its initial velocity.
//
// The length of a nearly shortest curve is wrong by the square of what its direction is wrong by. So a path that is
// good enough for its length is not for its direction: Newton's method goes on from there, and rays that are aimed at
// q have the last word.

#include "taut/query/tangent_maps.hpp"

#include <cmath>
#include <utility>

#include "curve/polished.hpp"

namespace taut {

LogMapResult log_map(PathSolver& solver, const VectorIn& p, const VectorIn& q, const Context& context) {
  const Surface& surface = solver.surface();
  const PathResult path = solver.solve(p, q);
  LogMapResult result;
  result.status = path.status;
  result.message = path.message;
  result.from = path.from;
  result.to = path.to;
  result.length = path.length;
  result.length_error = path.length_error;
  result.unique = path.unique;
  result.tied = path.tied;
  const Index d = surface.dim();
  result.direction = result.arrival = Vector::Constant(d, std::numeric_limits<double>::quiet_NaN());
  if (path.status == Status::ok && path.length == 0) result.miss = 0;
  const Index last = path.points.cols() - 1;
  if (last < 1 || !(path.length > 0)) return result;
  if (path.pieces.size() > 1) {  // over edges: its first arc's direction is known, the last one's by its points
    if (path.start_direction.size() == d) result.direction = path.start_direction;
    result.arrival = (path.points.col(last) - path.points.col(last - 1)).normalized();
    return result;
  }
  const NewtonResult fine = detail::polished(surface, path.points, context);
  if (fine.curve.num_elements() == 0) return result;
  result.curve = fine.curve;
  // Where the finer tolerance is not met, lengths agree within their errors all the same; the smaller error counts.
  if (fine.status == Status::ok || fine.length_error < path.length_error) {
    result.length = fine.length;
    result.length_error = fine.length_error;
  }
  const detail::EndDirections ends = detail::end_directions(surface, fine, context);
  result.direction = ends.departure;
  result.arrival = ends.arrival;
  result.miss = ends.miss;
  if (d - surface.codim() == 2) {
    result.scales = geodesic_scales(surface, result.from, result.direction, result.length);
  }
  return result;
}

LogMapResult log_map(const Surface& surface, const VectorIn& p, const VectorIn& q, const PathOptions& options,
                     const Context& context) {
  PathSolver solver(surface, options, context);
  return log_map(solver, p, q, context);
}

}  // namespace taut
