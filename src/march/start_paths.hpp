#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

/// A polyline between two points, to start a correction from.
struct StartPath {
  /// u_p + u_q where it crosses the bisector: its length by the fields, model units. The polyline itself is a little
  /// longer.
  double length = 0;
  Points points;  ///< d x m, m >= 2, from p to q
};

struct StartPathOptions {
  /// Ways round up to this part longer than the shortest are taken; infinity = all of them.
  double excess = 0.02;
  Index max_paths = 8;  ///< >= 1
  /// Starts through places closer to each other than this part of the distance to the nearer end, > 0, or than 0.8
  /// cells, count as one. On a smooth surface they lead to one geodesic.
  double spread = 0.1;
};

/// One start for each way round from p to q, shortest first. With the distances u_p and u_q from both ends, every
/// shortest path crosses the bisector u_p = u_q where s = u_p + u_q is least; other minima of s along the bisector are
/// its rivals, each of them the start of another geodesic. Where s is the same, up to the accuracy of the fields, along
/// a wide part of the bisector (q near the cut locus of p), several starts are spread over that part.
///
/// `from_p` and `from_q`: convergent fields with one source each on the same cells; they must reach beyond half the
/// distance, by `excess` at least. Empty when the bisector has no cell: the ends are within a few cells of each other,
/// or no way leads from one to the other. A way round is found only if both its halves are shortest paths.
/// Throws InvalidArgument when the fields do not fit, and Cancelled.
[[nodiscard]] std::vector<StartPath> start_paths(const Surface& surface, const SurfaceCells& cells,
                                                 const DistanceField& from_p, const DistanceField& from_q,
                                                 const StartPathOptions& options = {}, const Context& context = {});

}  // namespace taut::detail
