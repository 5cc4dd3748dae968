#pragma once

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// The geodesic of the arc's face from a to b, points of the face's zero set, near `arc.start`: fills all but the ends
/// of `arc`. False where it is not found.
[[nodiscard]] bool trace_face_arc(FacetedSurface& surface, ChainArc& arc, const Point3& a, const Point3& b,
                                  const Context& context);

}  // namespace taut::detail
