#pragma once

#include "taut/cells/mesh_surface.hpp"
#include "taut/query/point_sets.hpp"

namespace taut::paper {

/// Triangles over chosen points, the dual of their geodesic Voronoi regions: three points are joined where their
/// regions meet. `mesh` is made of the cells that the points were chosen on. Where the points are dense enough for
/// every region to be a disc, the result has the topology of the surface (Leibon and Letscher 2000).
[[nodiscard]] TriangleMesh geodesic_delaunay(const FarthestPoints& chosen, const SurfaceMesh& mesh);

/// Smallest angle of each triangle, degrees.
[[nodiscard]] Vector smallest_angles(const TriangleMesh& mesh);

}  // namespace taut::paper
