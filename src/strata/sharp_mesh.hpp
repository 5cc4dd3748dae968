#pragma once

#include "strata/edge_network.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/cells/cell_grid.hpp"
#include "taut/cells/mesh_surface.hpp"

namespace taut::detail {

/// Brings the edges of a surface into its mesh on these cells: each corner becomes a vertex, vertices next
/// to an edge move onto it, and triangles that still lie across one are cut there. Seams stay as they are. The mesh
/// stays a manifold with the normals of vertices on edges between those of the faces; with `part_faces` each face gets
/// its own vertices and normals along its edges, as pictures want them.
void sharpen_mesh(FacetedSurface& surface, const EdgeNetwork& network, const CellGrid& grid, bool part_faces,
                  SurfaceMesh& mesh);

}  // namespace taut::detail
