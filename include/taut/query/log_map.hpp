#pragma once

#include <limits>
#include <optional>
#include <string>

#include "taut/curve/geodesic_scales.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/query/path.hpp"

namespace taut {

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

}  // namespace taut
