#pragma once

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// How much the length falls when a path along the edge is moved off it, the same on both sides: the geodesic
/// curvatures of the edge towards the faces; at most 0 where it is pressed against the edge. On a border the free
/// side's.
[[nodiscard]] double pressed(FacetedSurface& surface, int edge, const Point3& x);

/// Makes arcs between two crossings of one edge that is pressed against arcs along it. False where there are none.
[[nodiscard]] bool follow_edges(FacetedSurface& surface, FacetChain& chain);

}  // namespace taut::detail
