#pragma once

#include "taut/query/path.hpp"

namespace taut {

/// The geodesic in the homotopy class of `polyline` (d x m, m >= 2, a point a column, in order): what a string laid
/// along it becomes when it is pulled taut over the surface with its ends held. Not the shortest path: a polyline that
/// winds twice round a handle stays wound twice. See docs/loops.md.
///
/// The points are projected onto the surface first. The class is kept by moving in steps shorter than a grid cell
/// (`PathOptions::cell`, half of it), and the corrected curve must follow the shortened polyline as closely; when it
/// does not, the status is not_converged. `PathOptions::method` newton or flow; `march`, `grid` and `all` play no part.
///
/// In the result `grid_path` is the polyline as it was before the correction, `candidates` has the path alone, and
/// neither `unique` nor `tied` holds: other ways are not looked for. A polyline that returns to its start and comes
/// undone is a path of length 0; `message` says so.
///
/// Throws InvalidArgument for a wrong shape, an option out of range, and, naming the points by their number from 1, for
/// a point without a surface within ten cells, or neighbours too far apart to tell their class; also EmptySurface,
/// OutOfMemory, Cancelled.
[[nodiscard]] PathResult path_in_class(const Surface& surface, const PointsIn& polyline,
                                       const PathOptions& options = {}, const Context& context = {});

}  // namespace taut
