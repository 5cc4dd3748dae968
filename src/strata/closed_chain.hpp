#pragma once

#include <cstddef>
#include <optional>

#include "strata/facet_chain.hpp"
#include "strata/facet_ways.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// The closed chain along a way that ends where it begins. Nothing where the way stays on one face.
[[nodiscard]] std::optional<FacetChain> closed_chain_of(FacetedSurface& surface, const FacetWay& way);

/// Stop `at` of a closed chain becomes its first and last one.
void begin_at(FacetChain& chain, std::size_t at);

}  // namespace taut::detail
