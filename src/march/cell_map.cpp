// What marches over the same complete cells share. The index of neighbours always pays. Charts do for surfaces (d - k =
// 2) whose cells are not too many and fit the limit of memory; without them a march works in double precision, about
// three times as long.
#include "march/cell_map.hpp"

#include "core/memory_limit.hpp"
#include "march/dimensions.hpp"

namespace taut::detail {
namespace {

/// Charts of so many take 100 MB.
constexpr Index kMostChartedCells = 200'000;
constexpr std::size_t kBytesPerCell = 500;

}  // namespace

std::shared_ptr<const CellMap> map_cells(const SurfaceCells& cells, const Context& context) {
  auto map = std::make_shared<CellMap>();
  with_dimensions(cells.dim(), cells.codim(),
                  [&]<int D, int K>() { map->neighbours = std::make_unique<const NeighbourIndex<D>>(cells); });
  const bool fits = kBytesPerCell * static_cast<std::size_t>(cells.num_cells()) <= memory_limit(context);
  if (cells.dim() - cells.codim() == 2 && cells.num_cells() <= kMostChartedCells && fits) {
    map->charts = std::make_unique<const SurfaceCharts>(cells, *map->neighbours, context);
  }
  return map;
}

}  // namespace taut::detail
