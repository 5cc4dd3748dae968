#pragma once

#include <cstddef>

#include "strata/facet_chain.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// Traces the arcs of one chain, again and again, within a budget.
class ArcTracer {
 public:
  /// Keeps the references.
  ArcTracer(FacetedSurface& surface, const Context& context) : surface_(surface), context_(context) {}

  /// Traces the arcs that are not `done` and sums the chain's length. False where one is not found, or the budget is
  /// used up.
  [[nodiscard]] bool trace(FacetChain& chain);
  /// The stop before the arc that was not found last.
  [[nodiscard]] std::size_t lost() const { return lost_; }

 private:
  [[nodiscard]] bool trace(ChainArc& arc, const Point3& a, const Point3& b);

  FacetedSurface& surface_;
  const Context& context_;
  int num_traced_ = 0;
  std::size_t lost_ = 0;
};

}  // namespace taut::detail
