#pragma once

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// A solved broken geodesic as a result: status, length, certificate, points and pieces. The result's ends are there
/// already.
void add_chain(FacetedSurface& surface, const FacetChain& chain, PathResult& result);

/// Its points, with exactly these ends: 3 x m.
[[nodiscard]] Points points_of(const FacetChain& chain, const Vector& from, const Vector& to);
/// Its own estimate, and rounding; model units.
[[nodiscard]] double length_error_of(const FacetChain& chain);

/// Why a chain is none, for PathResult::obstacle and PathResult::reason. `length` is that of the way it comes from.
void add_trouble(const ChainTrouble& trouble, double length, PathResult& result);

}  // namespace taut::detail
