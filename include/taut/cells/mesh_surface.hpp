#pragma once

#include <vector>

#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"
#include "taut/core/mesh.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct MeshOptions {
  /// >= 0: a vertex lies within this of the surface (|F| / |grad F|), model units; 0 = as far as rounding allows.
  double tolerance = 0;
  /// Cut the mesh where the surface's domain ends.
  bool cut_at_domain = true;
};

/// A triangle mesh whose vertices know their cells, so that what was computed on cells can be carried over.
struct SurfaceMesh : TriangleMesh {
  /// The cell of the grid each vertex came from: one entry a vertex. (Beside the domain's edge: a neighbouring cell.)
  std::vector<Index> cell;
  /// Sharp edges and borders, to be drawn as lines; `display_mesh` finds them.
  Polylines edges;
};

/// The display mesh of {F = 0} for d = 3, k = 1: the manifold dual of marching cubes on exactly the cells of `grid`. A
/// vertex for each piece of surface that the corner signs show in a cell, brought onto the surface by Newton's
/// method without leaving its cell by more than a quarter; two triangles for each grid edge that the surface crosses.
///
/// Properties: (1) the mesh is a manifold, whatever the signs: each edge bounds one or two triangles, in opposite
/// directions, and the triangles round a vertex form one fan; (2) it is closed where no cell is missing; (3) triangles
/// turn counter-clockwise seen from outside (where F > 0), normals are unit and point along grad F; (4) F = 0 exactly
/// at grid corners is no special case; (5) the number of threads changes nothing. Features thinner than a cell are not
/// seen. With a domain, triangles wholly outside are dropped and the vertices just outside move onto its edge.
///
/// Cells where F is NaN, and pieces where it jumps sign without a zero (1/x), leave holes. An empty grid gives an empty
/// mesh. Throws InvalidArgument unless d = 3 and k = 1, or when the grid has another dimension; OutOfMemory for more
/// than 2^28 cells; Cancelled.
[[nodiscard]] SurfaceMesh mesh_surface(const Surface& surface, const CellGrid& grid, const MeshOptions& options = {},
                                       const Context& context = {});

/// The zero set of a function in the plane as segments.
struct CurveMesh {
  Points vertices;            ///< 2 x n
  Points normals;             ///< 2 x n, unit, along grad F
  Eigen::Matrix2Xi segments;  ///< 2 x m, indices into `vertices`; the inside (F < 0) lies to the left
  std::vector<Index> cell;    ///< n: the cell each vertex came from
};

/// The same for d = 2, k = 1: a polyline for each connected curve, closed where no cell is missing. Throws
/// InvalidArgument unless d = 2 and k = 1.
[[nodiscard]] CurveMesh mesh_curve(const Surface& surface, const CellGrid& grid, const MeshOptions& options = {},
                                   const Context& context = {});

}  // namespace taut
