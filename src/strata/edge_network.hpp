#pragma once

#include <vector>

#include "strata/facet_graph.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// One edge from corner to corner, or all around.
struct EdgeLine {
  int edge = -1;
  std::vector<Point3> points;  ///< of the edge, in order; the last is the first again where it is closed
  bool closed = false;
  bool cut = false;  ///< it goes on where the box ends, or could not be followed to an end
  double length = 0;
  double angle = 0;  ///< largest angle between the faces' normals along it, radians; 0 of a border
};

/// A point where edges end.
struct EdgeCorner {
  Point3 x;
  std::vector<int> faces;
  bool touching = false;  ///< the faces have one tangent plane there
};

/// All edges and corners of a surface in a box.
struct EdgeNetwork {
  std::vector<EdgeLine> lines;
  std::vector<EdgeCorner> corners;
  std::vector<int> patches;  ///< one a face: into how many pieces that hang together it falls
};

/// Below this angle between its faces, radians, an edge is a seam: only the curvature jumps there.
inline constexpr double kSeamAngle = 1e-5;

/// Follows every edge that the graph has points of, in the graph's box. Lengths are exact to rounding, but for edges
/// that end where their faces touch: that point is known to about 1e-6 of the model.
[[nodiscard]] EdgeNetwork edge_network(FacetedSurface& surface, const FacetGraph& graph, const Context& context);

}  // namespace taut::detail
