#pragma once

#include "taut/cells/mesh_surface.hpp"
#include "taut/query/path.hpp"

namespace taut {

struct DisplayMeshOptions {
  double cell = 0;  ///< grid cell size h, model units; 0 = chosen: as fine as the surface needs, within a budget
  double cell_at_most = 0;  ///< the chosen size is no larger than this; 0 = whatever is chosen
  GridMethod grid = GridMethod::automatic;
  /// True: vertices lie on the surface to rounding. False: within 1/500 of a cell, which no picture shows and which
  /// saves half of the work.
  bool exact = true;
  /// d x n: places that must be in the picture; they decide which part of a surface without end is shown.
  Points near = {};
  /// True: faces that meet in an edge have their own vertices and normals there, so that pictures show it sharp. The
  /// mesh is no manifold then.
  bool part_faces = false;
  Points seeds = {};  ///< d x n: where Algorithm II begins on a surface that brings no samples (grid = grow)
  int component = 0;  ///< one connected piece alone (d = 3): 1 the largest by area, 2 the next, ...; 0 = all
};

/// The surface as triangles, its box and cell size chosen: `mesh_surface` for people in a hurry. Cells are half as
/// large as those that paths are marched on, or coarser where there would be more than 20,000 of a fitted surface
/// (150,000 of another one). Edges and corners of formulas with `min max abs sign`, and those of a domain, are in the
/// mesh: each corner is a vertex, and edges are chains of its sides. Throws as `mesh_surface` does, EmptySurface when
/// there is nothing to mesh, and InvalidArgument where it has fewer components than asked for.
[[nodiscard]] SurfaceMesh display_mesh(const Surface& surface, const DisplayMeshOptions& options = {},
                                       const Context& context = {});

/// The same for a curve in the plane (d = 2, k = 1): `mesh_curve`.
[[nodiscard]] CurveMesh display_curve(const Surface& surface, const DisplayMeshOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
