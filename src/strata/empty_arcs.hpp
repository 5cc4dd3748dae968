#pragma once

#include "strata/facet_chain.hpp"

namespace taut::detail {

/// Arcs no longer than `together` go: an end on an edge belongs to both faces; two stops in one place are a corner, or
/// nothing. The arcs must have been traced. True when some went.
bool drop_empty_arcs(FacetChain& chain, double together);

}  // namespace taut::detail
