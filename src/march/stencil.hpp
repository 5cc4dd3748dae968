#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "taut/cells/cell_grid.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// 3^d.
inline Index block_size(Index dim) {
  Index count = 1;
  for (Index i = 0; i < dim; ++i) count *= 3;
  return count;
}

/// Finds the present cells around a cell: those that differ by at most one in every coordinate.
class Stencil {
 public:
  explicit Stencil(Index dim) : coordinates_(static_cast<std::size_t>(dim)), base_(coordinates_.size()) {
    present_.reserve(static_cast<std::size_t>(block_size(dim)));
  }

  /// The present cells of the 3^d block around integer coordinates `centre`, its middle included, in a fixed order.
  /// The span lives until the next call. The same block again, as walks ask for it, costs nothing.
  [[nodiscard]] std::span<const Index> block(const CellGrid& grid, std::span<const std::int32_t> centre) {
    if (&grid == grid_ && grid.num_cells() == num_cells_ && std::ranges::equal(centre, centre_)) return present_;
    grid_ = &grid;
    num_cells_ = grid.num_cells();
    centre_.assign(centre.begin(), centre.end());
    present_.clear();
    const std::size_t dim = coordinates_.size();
    for (std::size_t i = 0; i < dim; ++i) coordinates_[i] = base_[i] = centre[i] - 1;
    // The last line carries like an odometer; it leaves i = dim after the last cell.
    for (std::size_t i = 0; i < dim;) {
      const Index cell = grid.find(coordinates_);
      if (cell != CellGrid::kNone) present_.push_back(cell);
      for (i = 0; i < dim && ++coordinates_[i] > base_[i] + 2; ++i) coordinates_[i] = base_[i];
    }
    return present_;
  }

 private:
  std::vector<std::int32_t> coordinates_;
  std::vector<std::int32_t> base_;
  std::vector<Index> present_;
  // What present_ is the block of.
  const CellGrid* grid_ = nullptr;
  Index num_cells_ = 0;
  std::vector<std::int32_t> centre_;
};

}  // namespace taut::detail
