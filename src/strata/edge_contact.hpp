#pragma once

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// By how much the length of a path along the edge falls, per length and offset, where a piece of it is moved onto one
/// of the faces: the larger of the geodesic curvatures of the edge towards its faces (on a border, of its one face).
/// The path is pressed against the edge where that is at most 0. Where only their sum is, it leaves the edge on the
/// face that pulls, and crosses it twice.
[[nodiscard]] double pressed(FacetedSurface& surface, int edge, const Point3& x);

/// Makes arcs between two crossings of one edge that is pressed against arcs along it. False where there are none.
[[nodiscard]] bool follow_edges(FacetedSurface& surface, FacetChain& chain);

}  // namespace taut::detail
