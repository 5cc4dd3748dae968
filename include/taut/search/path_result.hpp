#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/curve/flow.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/search/doubt.hpp"
#include "taut/search/path_options.hpp"

namespace taut {

/// Wall-clock seconds of each stage. Stages shared by several paths count for the first of them.
struct PathSeconds {
  double cells = 0;  ///< with the search for a box
  double march = 0;
  double correct = 0;
};

/// One geodesic among several between the same two points.
struct PathCandidate {
  double length = 0;        ///< model units
  double length_error = 0;  ///< as in Geodesic
  bool locally_shortest = false;
  Points points;  ///< d x m
};

/// A piece of a path on a surface with edges, corners or a border.
struct PathPiece {
  enum class Kind {
    face,      ///< a geodesic arc on a smooth face
    edge,      ///< an arc along an edge between two faces
    border,    ///< an arc along the border of the surface
    crossing,  ///< of an edge: a point
    corner,    ///< a point
  };
  Kind kind = Kind::face;
  std::string face;   ///< of an arc on a face: the formula that holds there, as text
  double length = 0;  ///< of an arc, model units
  Vector point;       ///< d: where the piece begins, or the point
  /// Radians. At a crossing: between the path and the edge, on either side. At a corner: the angle of the surface on
  /// the left and on the right of the path, infinite over a border; both are at least pi.
  double left = 0;
  double right = 0;
};

[[nodiscard]] constexpr std::string_view to_string(PathPiece::Kind kind) {
  switch (kind) {
    case PathPiece::Kind::face: return "face";
    case PathPiece::Kind::edge: return "edge";
    case PathPiece::Kind::border: return "border";
    case PathPiece::Kind::crossing: return "crossing";
    case PathPiece::Kind::corner: return "corner";
  }
  return "unknown";
}

/// A path: the geodesic and how it was found.
struct PathResult : Geodesic {
  Vector from;  ///< d: the start, on the surface
  Vector to;    ///< d: the end, on the surface
  /// Why `status` is not ok, in one sentence, or why the path may not be the shortest: `obstacle` and `doubts` in
  /// words.
  std::string message;
  double cell = 0;  ///< h of the cells that were walked, model units
  Index num_cells = 0;
  Index num_layers = 0;                     ///< of the envelope, PathOptions::envelope
  GridMethod grid = GridMethod::automatic;  ///< how they were found; automatic = there are none
  /// False where nothing was corrected (CorrectionMethod::grid): `status` ok then says that there is a marched path,
  /// `points` are its corners, `residual` is what they and what lies between them miss.
  bool corrected = true;
  /// The distance of the ends by the march that led to `grid_path`, model units; NaN where there was none (walks).
  double marched = std::numeric_limits<double>::quiet_NaN();
  Points grid_path;     ///< d x g: the marched path, which the correction started from
  Points walked_cells;  ///< d x n: centres of the cells that the march visited, if PathOptions::keep_cells
  /// Distinct geodesics that were found, shortest first; the first one is this path. Without PathOptions::all only
  /// those that might have been the shortest were looked for.
  std::vector<PathCandidate> candidates;
  /// True when no doubt is left that this is the only shortest path: other ways round were looked for, none is as
  /// short.
  bool unique = false;
  /// Another candidate is as short, within the errors of both or the tolerance. Neither `unique` nor `tied`: not known.
  bool tied = false;
  /// Why there may be a shorter path, or another one as short, that was not found.
  Doubts doubts;
  /// Why `status` is not ok.
  Obstacle obstacle;
  /// What was tried, in order.
  std::vector<RungReport> rungs;
  /// Where the surface goes on beyond the box that was looked through (Doubt::beyond_window): that box.
  Box window;
  /// In order from start to end, on a surface that is not smooth, or where the path meets its border; else empty.
  std::vector<PathPiece> pieces;
  PathSeconds seconds;
  /// Appendix II of the paper, of this curve; empty where no flow corrected it.
  std::optional<FlowSummary> flow;
};

}  // namespace taut
