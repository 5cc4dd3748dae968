#pragma once

#include <memory>

#include "march/cell_map.hpp"
#include "search/sharp_bends.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// Cells to march over, and what is known of them if they are complete.
struct Ground {
  std::shared_ptr<SurfaceCells> cells;
  std::shared_ptr<const CellMap> map;
  std::shared_ptr<const SharpBends> bends;
};

}  // namespace taut::detail
