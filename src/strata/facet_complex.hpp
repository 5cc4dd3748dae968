#pragma once

#include <memory>
#include <optional>

#include "strata/edge_network.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A surface's faces, edges and corners in a box.
struct FacetComplex {
  std::unique_ptr<FacetedSurface> surface;
  EdgeNetwork network;

  /// Nothing where the surface has neither edges nor a border, or where they are not looked for: surfaces that are
  /// fitted to samples, others than those of one equation in R^3, and those with too many kinks (FacetGraph::complete).
  /// Throws OutOfMemory, Cancelled.
  [[nodiscard]] static std::optional<FacetComplex> of(const Surface& surface, const Box& box, const Context& context);
};

}  // namespace taut::detail
