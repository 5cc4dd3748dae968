#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/path.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// A geodesic given by its start, as asked for by a user.
struct RayResult : ExponentialResult {
  Vector from;          ///< d: the start, on the surface
  std::string message;  ///< why `status` is not ok, in one sentence; empty otherwise
  /// In order from the start, on a surface in R^3 whose formula has kinks: arcs on faces and the edges that the ray
  /// crosses between them. There the part of its direction along the edge is kept, as if the faces were unfolded.
  std::vector<PathPiece> pieces;
};

/// Geodesics from given points in given directions on one surface. Not for sharing between threads.
class RaySolver {
 public:
  /// Throws InvalidArgument for options out of range. Does no work yet. `options.tolerance` 0 stands for 1e-9 on a
  /// dense fit (`fit_rbf`), whose third derivatives jump at its samples.
  explicit RaySolver(Surface surface, ExponentialOptions options = {}, Context context = {});
  ~RaySolver();
  RaySolver(RaySolver&&) noexcept;
  RaySolver& operator=(RaySolver&&) noexcept;

  /// ExponentialMap::trace after the checks of PathSolver::solve: a start off the surface by more than a cell, and a
  /// direction that points off the surface by more than a degree, are told through Context::note; a start off by more
  /// than ten cells, or outside the domain, throws InvalidArgument. On a surface with edges the ray crosses them; it
  /// ends at a border (left_domain), in a corner or along an edge (not_converged). Conjugate points are looked for as
  /// long as it stays on one face.
  [[nodiscard]] RayResult solve(const VectorIn& from, const VectorIn& direction, double length);

  /// Column j of `from` and `directions` (d x n) with `lengths`(j), on all threads; answer j does not depend on the
  /// others. A ray that cannot be answered carries its status and message; throws Cancelled only.
  [[nodiscard]] std::vector<RayResult> solve_many(const PointsIn& from, const PointsIn& directions,
                                                  const VectorIn& lengths);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// log_p(q): the initial velocity of the shortest geodesic from p that is at q at time 1.
struct LogMapResult {
  Status status = Status::not_converged;  ///< of the shortest path
  std::string message;                    ///< why it is not ok, in one sentence; where it is, as PathResult::message
  Vector from;                            ///< d: p, on the surface
  Vector to;                              ///< d: q, on the surface
  Vector direction;                       ///< d: the unit tangent at p; NaN where there is no path, and for p = q
  Vector arrival;                         ///< d: the unit tangent at q, direction of travel; NaN likewise
  double length = 0;                      ///< model units: |log_p(q)|, the distance
  double length_error = 0;                ///< as in Geodesic
  /// How far from q the ray from p in this direction ends after `length`, model units: the log map checked by an
  /// exponential map that shares nothing with it but F. NaN where the ray does not get that far.
  double miss = std::numeric_limits<double>::quiet_NaN();
  bool unique = false;                   ///< as in PathResult: no other direction is as good, and no doubt is left
  bool tied = false;                     ///< as in PathResult: another direction is as good
  std::optional<GeodesicScales> scales;  ///< on 2-surfaces
  SpectralCurve curve;                   ///< the geodesic from p to q, as exact as rounding allows; empty without one

  /// d: length times direction; zero for p = q, NaN where there is no path.
  [[nodiscard]] Vector velocity() const { return length > 0 ? Vector(length * direction) : Vector::Zero(from.size()); }
};

/// The log map at p of q (d each, projected as by PathSolver::solve), by the shortest path, corrected until rounding
/// forbids more: directions are good to some 1e-12 times the spread of rays. For many targets on one surface see
/// DistanceSolver, whose `departure` is the direction. Of a path over edges (PathResult::pieces) `arrival` is the
/// direction between its last two points, and there are no `miss`, `scales` and `curve`. Throws what PathSolver::solve
/// throws. Properties the tests check: exp_p(log_p(q)) = q; log_p(exp_p(v)) = v where that way is the shortest;
/// references.
[[nodiscard]] LogMapResult log_map(PathSolver& solver, const VectorIn& p, const VectorIn& q,
                                   const Context& context = {});

/// The same once.
[[nodiscard]] LogMapResult log_map(const Surface& surface, const VectorIn& p, const VectorIn& q,
                                   const PathOptions& options = {}, const Context& context = {});

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
