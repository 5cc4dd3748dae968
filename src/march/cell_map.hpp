#pragma once

#include <memory>

#include "march/neighbour_index.hpp"
#include "march/surface_charts.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// What is known of complete cells before anything is done over them.
struct CellMap {
  std::unique_ptr<const AnyNeighbourIndex> neighbours;
  std::unique_ptr<const SurfaceCharts>
      charts;  ///< of surfaces (d - k = 2), where the cells are not too many; else null
};

/// Takes about as long as a march over all cells. Keeps a reference to them.
[[nodiscard]] std::shared_ptr<const CellMap> map_cells(const SurfaceCells& cells, const Context& context);

}  // namespace taut::detail
