#pragma once

#include <cstddef>
#include <vector>

#include "strata/arc_tracer.hpp"
#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// A stop that would go on beyond the end of its edge.
struct StopAtEnd {
  std::size_t stop = 0;
  int condition = -1;  ///< that ends the edge; -1: not known
};

/// What came of sliding.
struct SlidStops {
  bool settled = false;
  ChainTrouble trouble;  ///< why it did not
  std::vector<StopAtEnd> at_end;
};

/// Moves the crossings and contacts of a chain along their edges until it is stationary, by Newton's method with exact
/// second derivatives. Ends early where an arc has shrunk to nothing.
[[nodiscard]] SlidStops slide_stops(FacetedSurface& surface, ArcTracer& tracer, FacetChain& chain,
                                    const Context& context);

/// Eigenvalues of the second derivative of a settled chain's length by the places of its crossings, 1 / model units,
/// least first. Where the chain follows an edge, its contacts change the length by the third order only, and do not
/// move the crossings: they count as fixed.
[[nodiscard]] Vector second_variation(FacetedSurface& surface, const FacetChain& chain);

}  // namespace taut::detail
