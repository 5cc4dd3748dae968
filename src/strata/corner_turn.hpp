#pragma once

#include <cstddef>

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// Stop i of a chain is in a corner: leaves it on the side where the surface has less than 180 degrees, over the edges
/// there. Else fills the stop's angles. True when it left.
[[nodiscard]] bool leave_corner(FacetedSurface& surface, FacetChain& chain, std::size_t i);

}  // namespace taut::detail
