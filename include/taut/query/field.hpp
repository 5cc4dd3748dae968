#pragma once

#include "taut/cells/mesh_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/march/march.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct FieldOptions {
  MarchMethod march = MarchMethod::convergent;
  GridMethod grid = GridMethod::automatic;
  double cell = 0;     ///< grid cell size h, model units; 0 = chosen
  Index envelope = 0;  ///< as PathOptions::envelope
  Points seeds = {};   ///< as PathOptions::seeds
};

/// Distances from a source to everywhere, for display and for a quick answer: as exact as the cells (docs/march.md).
struct FieldResult {
  /// d = 3: the display mesh (`display_mesh`, its cells no larger than FieldOptions::cell) with a vertex scalar
  /// "distance" (model units, NaN where no path leads). Empty otherwise.
  SurfaceMesh mesh;
  /// Marched over the triangles of the mesh, since the surface has edges: its vertices stand in for cells.
  bool over_mesh = false;
  Points points;    ///< d x n: the cells' surface points; their centres for a march between those (axis, an envelope)
  Vector distance;  ///< n: distance at each, infinity where no path leads
  double cell = 0;  ///< h, model units
  Index num_cells = 0;
  Index num_layers = 0;                     ///< of the envelope
  GridMethod grid = GridMethod::automatic;  ///< how the cells were found
};

/// Marches from the nearest of `sources` (d x s, projected onto the surface) over all cells; d at most 6. Of a surface
/// without end, cells are made in a box around the sources (find_extent); only paths in it count then, which is told.
/// Where the formula has edges (`min max abs sign`, d = 3) the convergent march goes over the mesh's triangles.
/// Throws as PathSolver::solve.
[[nodiscard]] FieldResult marched_field(const Surface& surface, const PointsIn& sources,
                                        const FieldOptions& options = {}, const Context& context = {});

}  // namespace taut
