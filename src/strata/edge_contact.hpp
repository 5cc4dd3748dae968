#pragma once

#include <cstddef>

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// How a path along an edge is drawn onto one of its faces.
struct EdgePull {
  /// By how much its length falls, per length and offset, where a piece of it is moved onto `face`: the geodesic
  /// curvature of the edge towards it. Infinite where the edge is singular.
  double curvature;
  int face;
};
/// Towards that of its faces which pulls the most; on a border towards the one face. The path is pressed against the
/// edge where that is at most 0. Where only the sum of both is, it leaves the edge on the face that pulls, and crosses
/// it twice.
[[nodiscard]] EdgePull strongest_pull(FacetedSurface& surface, int edge, const Point3& x);

/// Makes arcs between two crossings of one edge that is pressed against arcs along it. False where there are none.
[[nodiscard]] bool follow_edges(FacetedSurface& surface, FacetChain& chain);

/// Where a face pulls at a part of an arc along an edge, that part goes over the face: it leaves the edge and comes
/// back to it along it, or crosses it where the arc begins or ends. One part; false where there is none.
[[nodiscard]] bool lift_from_edge(FacetedSurface& surface, FacetChain& chain, std::size_t i);

}  // namespace taut::detail
