#pragma once

#include <optional>

#include "strata/facet_ways.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// A polyline (3 x m, near the surface) as a way over its faces: points are projected, and where neighbours lie on
/// different faces the edge between them is found. Nothing where a point has no foot on its face, or neighbours are
/// joined by no row of faces.
[[nodiscard]] std::optional<FacetWay> way_along_polyline(FacetedSurface& surface, const Points& polyline);

}  // namespace taut::detail
