#include "query/normal_turns.hpp"

#include <algorithm>
#include <cstdint>

#include "cells/normal_turn.hpp"

namespace taut::detail {

NormalTurns::NormalTurns(const SurfaceCells& cells) {
  const CellGrid& grid = cells.grid();
  const auto d = static_cast<std::size_t>(cells.dim());
  std::vector<std::int32_t> next(d);
  for (Index i = 0; i < cells.num_cells(); ++i) {
    if (!cells.valid(i)) continue;
    for (std::size_t axis = 0; axis < d; ++axis) {
      std::ranges::copy(grid.cell(i), next.begin());
      ++next[axis];
      const Index j = grid.find(next);
      if (j == CellGrid::kNone || !cells.valid(j)) continue;
      turns_.push_back(normal_turn(cells, i, j));
    }
  }
  constexpr double kMissing = 0.75;
  const auto dimension = static_cast<double>(cells.dim() - cells.codim());
  const auto sought = dimension * static_cast<double>(cells.num_valid());  // a pair is seen from one side only
  makes_a_sheet_ = static_cast<double>(turns_.size()) >= kMissing * sought;
}

double NormalTurns::quantile(double part) {
  if (turns_.empty()) return 0;
  const auto at = turns_.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(turns_.size()));
  std::nth_element(turns_.begin(), at, turns_.end());
  return *at;
}

}  // namespace taut::detail
