#pragma once

#include <memory>
#include <vector>

#include "march/cell_map.hpp"
#include "march/start_paths.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

// Marches, descents and starts over cells of which there may be a map; null: there is none.

[[nodiscard]] DistanceField march_over(const Surface& surface, SurfaceCells& cells, const CellMap* map,
                                       const PointsIn& sources, const MarchOptions& options, const Context& context);

[[nodiscard]] Points descend_over(const Surface& surface, const SurfaceCells& cells, const CellMap* map,
                                  const DistanceField& field, const VectorIn& target);

[[nodiscard]] std::vector<StartPath> start_paths_over(const Surface& surface, const SurfaceCells& cells,
                                                      const CellMap* map, const DistanceField& from_p,
                                                      const DistanceField& from_q, const StartPathOptions& options,
                                                      const Context& context);

}  // namespace taut::detail
