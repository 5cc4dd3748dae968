#pragma once

#include <optional>

#include "march/start_paths.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The shortest way from p to q (on the surface) over the cells' points of which no step leaves the domain, as a
/// polyline: some 3 % too long. A march goes from cell to cell and may jump a gap that is narrower than they are; this
/// looks at every step. None where there is no such way. Surfaces in R^3 (k = 1) with a domain, complete cells.
[[nodiscard]] std::optional<StartPath> way_inside(const Surface& surface, const SurfaceCells& cells, const Vector& p,
                                                  const Vector& q, const Context& context);

}  // namespace taut::detail
