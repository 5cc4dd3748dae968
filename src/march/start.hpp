#pragma once

#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// The valid cells of the block around a point (d).
[[nodiscard]] std::vector<Index> cells_around(const SurfaceCells& cells, const VectorIn& x);

/// Those around a source. Throws InvalidArgument when there is none.
[[nodiscard]] std::vector<Index> cells_around_source(const SurfaceCells& cells, const VectorIn& source);

}  // namespace taut::detail
