#pragma once

#include "strata/facet_chain.hpp"
#include "strata/facet_ways.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// The arcs and stops along a way over the graph.
[[nodiscard]] FacetChain chain_of(FacetedSurface& surface, const FacetWay& way);

}  // namespace taut::detail
