#pragma once

#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// Where a walk along an edge came to.
struct EdgeWalk {
  bool possible = false;  ///< the edge could be followed
  Point3 x = Point3::Zero();
  /// Met the end of the edge: +1 in the direction of its tangent, -1 against it; 0 = did not.
  int end = 0;
  int condition = -1;  ///< that ends it, -1: none is known
};

/// From x along an edge by about `step`, at most to where it ends.
[[nodiscard]] EdgeWalk walk_along(FacetedSurface& surface, int edge, const Point3& x, double step);

}  // namespace taut::detail
