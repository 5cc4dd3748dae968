#pragma once

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// The arc of the edge `arc.edge` from a to b, points of it, over those of `arc.start` between them: length, tangents
/// and points. False where the edge is not followed.
[[nodiscard]] bool trace_edge_arc(FacetedSurface& surface, ChainArc& arc, const Point3& a, const Point3& b);

}  // namespace taut::detail
