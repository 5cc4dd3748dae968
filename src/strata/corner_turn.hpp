#pragma once

#include <cstddef>

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// What became of a stop in a corner.
struct CornerTurn {
  bool left = false;  ///< the chain left it
  bool both = false;  ///< the surface has less than 180 degrees on the other side, too: round it leads another path
};

/// Stop i of a chain is in a corner: leaves it on the side where the surface has least, less than 180 degrees, over the
/// edges there; with `wider_side` on the other one, where that has less than 180 degrees, too. Else fills the stop's
/// angles.
[[nodiscard]] CornerTurn leave_corner(FacetedSurface& surface, FacetChain& chain, std::size_t i,
                                      bool wider_side = false);

}  // namespace taut::detail
