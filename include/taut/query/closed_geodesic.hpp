#pragma once

#include "taut/query/path.hpp"

namespace taut {

/// A closed geodesic. The PathResult part: `points` end with the first one again, `from` = `to` is that point, `length`
/// is once round, `start_direction` the tangent there; `candidates` has this one alone. `index` counts the independent
/// ways to make it shorter to second order.
struct ClosedGeodesic : PathResult {
  /// The loop shrinks to a point in its class: status ok, length 0, `points` that point twice; `message` says so.
  bool is_point = false;
  /// The largest angle between arriving and leaving at the points where its arcs are joined, radians.
  double kink = 0;
  /// Independent ways to move it without changing its length to second order, within what differences resolve: 1 for a
  /// loop round a cylinder, 2 for a great circle.
  int neutral = 0;
};

/// The closed geodesic in the free homotopy class of a loop (`polyline`, d x m, m >= 3; the last point is joined to the
/// first, and may repeat it). A loop that lies within one grid cell of a closed geodesic is corrected to that one,
/// minimum or not; any other is shortened until it rests on one, or is a point. See docs/loops.md.
///
/// Points, steps and class are treated as by path_in_class, which also says what is thrown. `PathOptions::method` must
/// be newton. Status: ok; not_converged with the shortened loop where the arcs or their joints do not come to rest;
/// left_domain, rank_deficient.
[[nodiscard]] ClosedGeodesic closed_geodesic(const Surface& surface, const PointsIn& polyline,
                                             const PathOptions& options = {}, const Context& context = {});

}  // namespace taut
