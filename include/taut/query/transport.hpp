#pragma once

#include <string>

#include "taut/curve/parallel_transport.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/path.hpp"

namespace taut {

/// Vectors carried from the first of several points to the last.
struct TransportResult : CarriedVectors {
  std::string message;  ///< why `status` is not ok, in one sentence; also where a path may not be the shortest
  Vector from;          ///< d: the first point, on the surface
  Vector to;            ///< d: the last one, on the surface
  double length = 0;    ///< of the way, model units
  bool unique = true;   ///< as in PathResult, of every part of the way
  bool tied = false;    ///< as in PathResult, of some part
};

/// Carries `vectors` (d x m; their tangential parts count) parallel along the shortest path from column 0 of
/// `stations` (d x n, n >= 2, projected as by PathSolver::solve) to column 1, on to column 2, and so on. Two stations:
/// along the shortest path between them. Points along a curve, each near the next: along the curve, with an error of
/// second order in their distances (the curve is replaced by a geodesic polygon, on which transport is exact). A closed
/// polygon gives its holonomy. The status is that of the first part of the way that fails. Throws InvalidArgument for
/// a wrong shape, and what PathSolver::solve throws. Keeps lengths and angles between vectors to rounding.
[[nodiscard]] TransportResult transport_along(PathSolver& solver, const PointsIn& stations, const PointsIn& vectors,
                                              const Context& context = {});

/// Carries `vectors` (d x m, at `source`) along the shortest geodesics to all targets (d x n) of a field with this one
/// source: `distances` are DistanceSolver's answer at `targets`, which are projected onto the surface here, too.
/// Columns j m .. j m + m - 1 of the result (d x n m) belong to target j; NaN where there is no geodesic. For surfaces
/// in R^3, where a vector keeps its angle to the geodesic: no equation is solved, and it is as exact as the directions
/// of departure and arrival. Throws InvalidArgument in other dimensions and for shapes that do not fit.
[[nodiscard]] Points transport_to_targets(const Surface& surface, const VectorIn& source, const PointsIn& targets,
                                          const Distances& distances, const PointsIn& vectors);

}  // namespace taut
