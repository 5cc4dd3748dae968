// Connected components of cells, by union and find over the 3^d - 1 neighbours, or across faces only. Labels count from
// 0 in the order of the components' first cells, whatever the order of the unions.
#include "taut/cells/find_cells.hpp"

#include "core/disjoint_sets.hpp"

namespace taut {
namespace {

/// By the set that each kept cell is in, in the order of their first cells.
template <class Keep>
Components numbered(detail::DisjointSets& sets, Index n, Keep keep) {
  Components result;
  result.label.assign(static_cast<std::size_t>(n), Components::kNone);
  for (Index i = 0; i < n; ++i) {
    if (!keep(i)) continue;
    const std::uint32_t root = sets.find(static_cast<std::uint32_t>(i));
    result.label[static_cast<std::size_t>(i)] =
        // A root is the least cell of its set: it has its label before all others.
        root == static_cast<std::uint32_t>(i) ? result.count++ : result.label[root];
  }
  return result;
}

template <class Keep>
Components label(const CellGrid& grid, Keep keep) {
  const Index n = grid.num_cells();
  detail::DisjointSets sets(static_cast<std::size_t>(n));
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
  return numbered(sets, n, keep);
}

}  // namespace

Components components(const CellGrid& grid) {
  return label(grid, [](Index) { return true; });
}

Components components_across_faces(const CellGrid& grid) {
  const Index n = grid.num_cells();
  detail::DisjointSets sets(static_cast<std::size_t>(n));
  std::vector<std::int32_t> before;
  for (Index i = 0; i < n; ++i) {
    const auto cell = grid.cell(i);
    before.assign(cell.begin(), cell.end());
    // The cell before it on each axis: every pair is met from one side.
    for (auto& c : before) {
      --c;
      const Index j = grid.find(before);
      if (j != CellGrid::kNone) sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      ++c;
    }
  }
  return numbered(sets, n, [](Index) { return true; });
}

Components components(const SurfaceCells& cells) {
  return label(cells.grid(), [&](Index i) { return cells.valid(i); });
}

}  // namespace taut
