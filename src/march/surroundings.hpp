#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "march/cell_map.hpp"
#include "march/stencil.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// Finds the cells around a place by an index of all neighbours, where there is one, else in the grid.
template <int D>
class Surroundings {
 public:
  Surroundings(const SurfaceCells& cells, const CellMap* map)
      : grid_(cells.grid()),
        index_(map == nullptr ? nullptr : static_cast<const NeighbourIndex<D>*>(map->neighbours.get())),
        stencil_(grid_.dim()) {}

  /// Those of the 3^d block around integer coordinates `centre` that may be valid, its middle included, in a fixed
  /// order. The span lives until the next call. The same block again, as walks ask for it, costs nothing.
  [[nodiscard]] std::span<const Index> around(std::span<const std::int32_t> centre) {
    if (index_ == nullptr) return stencil_.block(grid_, centre);
    if (std::ranges::equal(centre, centre_)) return present_;
    centre_.assign(centre.begin(), centre.end());
    index_->around(centre.data(), present_);
    return present_;
  }

 private:
  const CellGrid& grid_;
  const NeighbourIndex<D>* index_;
  Stencil stencil_;
  std::vector<Index> present_;
  std::vector<std::int32_t> centre_;  // what present_ is the block of, by the index
};

}  // namespace taut::detail
