#pragma once

#include <memory>

#include "march/neighbour_index.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

/// The neighbours of complete cells, for many marches over them: filing all cells takes as long as marching over a
/// tenth of them.
[[nodiscard]] std::shared_ptr<const AnyNeighbourIndex> index_neighbours(const SurfaceCells& cells);

/// `march` over complete cells whose neighbours are known; null: they are not.
[[nodiscard]] DistanceField march_over(const Surface& surface, SurfaceCells& cells, const AnyNeighbourIndex* neighbours,
                                       const PointsIn& sources, const MarchOptions& options, const Context& context);

}  // namespace taut::detail
