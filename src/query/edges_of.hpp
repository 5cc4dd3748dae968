#pragma once

#include "strata/facet_complex.hpp"
#include "taut/query/surface_summary.hpp"

namespace taut::detail {

[[nodiscard]] SurfaceEdges edges_of(FacetComplex& complex);

}  // namespace taut::detail
