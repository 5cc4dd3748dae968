#include "taut/cells/components.hpp"

#include <functional>
#include <numeric>

namespace taut {
namespace {

/// Union by smaller index, path halving: a root is the first cell of its set.
class DisjointSets {
 public:
  explicit DisjointSets(Index n) : parent_(static_cast<std::size_t>(n)) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    if (i < j) parent_[j] = i;
    if (j < i) parent_[i] = j;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

template <class Keep>
Components label(const CellGrid& grid, Keep keep) {
  const Index n = grid.num_cells();
  DisjointSets sets(n);
  std::vector<Index> around(static_cast<std::size_t>(grid.num_neighbours()));
  for (Index i = 0; i < n; ++i) {
    if (!keep(i)) continue;
    grid.neighbours(i, around);
    for (const Index j : around) {
      if (j != CellGrid::kNone && j < i && keep(j)) {
        sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      }
    }
  }
  Components result;
  result.label.assign(static_cast<std::size_t>(n), Components::kNone);
  for (Index i = 0; i < n; ++i) {
    if (!keep(i)) continue;
    const std::uint32_t root = sets.find(static_cast<std::uint32_t>(i));
    result.label[static_cast<std::size_t>(i)] =
        root == static_cast<std::uint32_t>(i) ? result.count++ : result.label[root];
  }
  return result;
}

}  // namespace

Components components(const CellGrid& grid) {
  return label(grid, [](Index) { return true; });
}

Components components(const SurfaceCells& cells) {
  return label(cells.grid(), [&](Index i) { return cells.valid(i); });
}

}  // namespace taut
