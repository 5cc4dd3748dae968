#pragma once

#include <cstddef>
#include <limits>
#include <string>
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
  std::string why;  ///< it did not settle
  std::vector<StopAtEnd> at_end;
  /// Least eigenvalue of the length's second derivative, 1 / model units; infinite where no crossing moves, or the path
  /// follows an edge.
  double least_curvature = std::numeric_limits<double>::infinity();
};

/// Moves the crossings and contacts of a chain along their edges until it is stationary, by Newton's method with exact
/// second derivatives. Ends early where an arc has shrunk to nothing.
[[nodiscard]] SlidStops slide_stops(FacetedSurface& surface, ArcTracer& tracer, FacetChain& chain,
                                    const Context& context);

}  // namespace taut::detail
