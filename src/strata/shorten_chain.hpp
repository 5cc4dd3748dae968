#pragma once

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// Shortens a chain to a broken geodesic: its stops slide along their edges by Newton's method, where every arc is the
/// geodesic of its face between its stops; what a converged chain breaks (an arc that leaves its face, a stop at the
/// end of its edge, a corner with room to go round) changes the row of arcs. The result's conditions are checked.
void shorten_chain(FacetedSurface& surface, FacetChain& chain, const Context& context);

}  // namespace taut::detail
