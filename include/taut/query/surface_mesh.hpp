#pragma once

#include "taut/cells/mesh_surface.hpp"
#include "taut/query/path.hpp"

namespace taut {

struct DisplayMeshOptions {
  double cell = 0;  ///< grid cell size h, model units; 0 = chosen
  GridMethod grid = GridMethod::automatic;
};

/// The surface as triangles, its box and cell size chosen: `mesh_surface` for people in a hurry. Throws as it does, and
/// EmptySurface when there is nothing to mesh.
[[nodiscard]] SurfaceMesh display_mesh(const Surface& surface, const DisplayMeshOptions& options = {},
                                       const Context& context = {});

/// Centres (d x n) of the cells that the surface goes through, for pictures; d at most 6. Throws as `PathSolver` does.
[[nodiscard]] Points display_cells(const Surface& surface, const DisplayMeshOptions& options = {},
                                   const Context& context = {});

}  // namespace taut
