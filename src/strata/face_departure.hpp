#pragma once

#include <cstddef>

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// What was made of a chain.
struct ChainMove {
  bool changed = false;
  ChainTrouble stuck = {};  ///< why it is not known what to do
};

/// Arc i, traced, may leave its face: over an edge, which it then crosses or follows, or over corners that reach into
/// the face, which it then passes. `num_shifted` counts the crossings that were moved to the other side of their edge.
/// `closely`, on a surface with a domain: by looks_at_border, which finds what is smaller than parts of the arc.
[[nodiscard]] ChainMove keep_on_face(FacetedSurface& surface, FacetChain& chain, std::size_t i, bool closely,
                                     int& num_shifted);

}  // namespace taut::detail
