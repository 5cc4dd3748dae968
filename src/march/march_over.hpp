#pragma once

#include <memory>
#include <vector>

#include "march/neighbour_index.hpp"
#include "taut/march/march.hpp"
#include "taut/march/start_paths.hpp"

namespace taut::detail {

// Marches, descents and starts over complete cells whose neighbours are known; null: they are not.

/// The neighbours of complete cells, for all that is done over them: filing all cells takes as long as marching over a
/// tenth of them.
[[nodiscard]] std::shared_ptr<const AnyNeighbourIndex> index_neighbours(const SurfaceCells& cells);

[[nodiscard]] DistanceField march_over(const Surface& surface, SurfaceCells& cells, const AnyNeighbourIndex* neighbours,
                                       const PointsIn& sources, const MarchOptions& options, const Context& context);

[[nodiscard]] Points descend_over(const Surface& surface, const SurfaceCells& cells,
                                  const AnyNeighbourIndex* neighbours, const DistanceField& field,
                                  const VectorIn& target);

[[nodiscard]] std::vector<StartPath> start_paths_over(const Surface& surface, const SurfaceCells& cells,
                                                      const AnyNeighbourIndex* neighbours, const DistanceField& from_p,
                                                      const DistanceField& from_q, const StartPathOptions& options,
                                                      const Context& context);

}  // namespace taut::detail
