#pragma once

#include <string>

#include "taut/core/context.hpp"
#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/query/path.hpp"

namespace taut {

/// A Bezier curve on a surface.
struct BezierCurve {
  Status status = Status::not_converged;
  /// Why it is not ok, in one sentence; where it is, mostly empty: else why another curve would be as right.
  std::string message;
  Points points;      ///< d x n on the surface, up to where it got; the first and last control point exactly
  Vector parameter;   ///< n, 0 .. 1, equally spaced
  double length = 0;  ///< of the curve through `points`, model units; its error falls with the fourth power of n
  /// True when every geodesic of the construction is locally shortest and the curve of the reversed control points is
  /// the same curve: so it is where the control points lie in a ball that holds one geodesic between any two of its
  /// points. False: the control points lie too far apart for one curve to be the right one.
  bool unique = false;
};

/// Geodesic de Casteljau (Park and Ravani 1995): as in the plane, with geodesics for straight lines. `controls`
/// (d x (degree + 1), two or more) are projected onto the surface as by PathSolver::solve. The first row is of shortest
/// paths between neighbours; each geodesic between points of two of them is continued from parameter to parameter by
/// Newton's method, so that the curve is smooth even where the shortest path between those points would jump. It begins
/// and ends in the direction of the first and the last of these paths, with `degree` times their length as speed.
/// `num_points` >= 2. Points are exact to `solver`'s tolerance. Any dimension and number of equations. Throws
/// InvalidArgument for wrong shapes, and what PathSolver::solve throws.
[[nodiscard]] BezierCurve bezier_curve(PathSolver& solver, const PointsIn& controls, Index num_points,
                                       const Context& context = {});

}  // namespace taut
