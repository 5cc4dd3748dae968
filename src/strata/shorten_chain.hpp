#pragma once

#include <vector>

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// Shortens a chain to a broken geodesic: its stops slide along their edges by Newton's method, where every arc is the
/// geodesic of its face between its stops; what a converged chain breaks (an arc that leaves its face, a stop at the
/// end of its edge, a corner with room to go round) changes the row of arcs. The result's conditions are checked. Where
/// a corner can be passed on either side, the chain that takes the other one is added to `others`, to be shortened,
/// too.
void shorten_chain(FacetedSurface& surface, FacetChain& chain, std::vector<FacetChain>& others, const Context& context);

/// A chain and those that pass corners on their other sides, shortened, up to six besides; the first is the one given.
[[nodiscard]] std::vector<FacetChain> shorten_with_others(FacetedSurface& surface, FacetChain chain,
                                                          const Context& context);

}  // namespace taut::detail
