// Turns of the normal space between all valid cells that share a face, each pair once: a cell looks along the positive
// axes only. Blocks of cells are worked on in parallel and put together in order.
#include "search/normal_turns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cells/normal_turn.hpp"
#include "core/parallel.hpp"

namespace taut::detail {

NormalTurns::NormalTurns(const SurfaceCells& cells, const Context& context) {
  const CellGrid& grid = cells.grid();
  const auto d = static_cast<std::size_t>(cells.dim());
  constexpr Index kBlock = 512;
  std::vector<std::vector<float>> blocks(static_cast<std::size_t>((cells.num_cells() + kBlock - 1) / kBlock));
  parallel_for(context, 0, cells.num_cells(), kBlock, [&](Index first, Index last) {
    std::vector<float>& turns = blocks[static_cast<std::size_t>(first / kBlock)];
    turns.reserve(d * static_cast<std::size_t>(last - first));
    std::vector<std::int32_t> next(d);
    for (Index i = first; i < last; ++i) {
      if (!cells.valid(i)) continue;
      for (std::size_t axis = 0; axis < d; ++axis) {
        std::ranges::copy(grid.cell(i), next.begin());
        ++next[axis];
        const Index j = grid.find(next);
        if (j == CellGrid::kNone || !cells.valid(j)) continue;
        turns.push_back(static_cast<float>(normal_turn(cells, i, j)));
      }
    }
  });
  std::size_t count = 0;
  for (const std::vector<float>& block : blocks) count += block.size();
  turns_.reserve(count);
  for (const std::vector<float>& block : blocks) turns_.insert(turns_.end(), block.begin(), block.end());
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

bool NormalTurns::mostly_within(double most, double part) const {
  const auto within = std::ranges::count_if(turns_, [&](float turn) { return turn <= most; });
  return turns_.empty() || static_cast<double>(within) > std::floor(part * static_cast<double>(turns_.size()));
}

}  // namespace taut::detail
