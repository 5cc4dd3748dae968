#pragma once

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

struct CellMap;

/// What every method starts from: a checked request. `field` holds the sources with their normals and nothing else.
struct MarchTask {
  SurfaceCells& cells;
  const MarchOptions& options;
  const Context& context;
  Vector target_normals;         ///< d k: basis of the normal space at the target; empty without one
  const CellMap* map = nullptr;  ///< of the cells, where there is one
};

void march_convergent(const MarchTask& task, DistanceField& field);
void march_axis(const MarchTask& task, DistanceField& field);
void march_dijkstra(const MarchTask& task, DistanceField& field);

}  // namespace taut::detail
