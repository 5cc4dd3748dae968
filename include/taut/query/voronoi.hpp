#pragma once

#include <cstdint>
#include <vector>

#include "taut/cells/mesh_surface.hpp"
#include "taut/core/mesh.hpp"
#include "taut/query/distance.hpp"

namespace taut {

/// The parts of a surface in which one source is nearer than the others.
struct VoronoiResult {
  /// The display mesh, with vertex scalars "distance" (NaN where there is none) and "source" (as `label`, NaN
  /// likewise).
  SurfaceMesh mesh;
  std::vector<std::int32_t> label;  ///< by vertex: number of the nearest source, -1 where no source is reached
  /// Where two parts meet, a line a stretch, each with the lower-numbered part to its left seen from outside; scalars
  /// "left" and "right" are their numbers. Ends are where three parts meet, or where the mesh ends.
  Polylines boundaries;
  Index num_exact = 0;           ///< vertices whose label is proved by the fan; the others' are marched
  Index num_exact_boundary = 0;  ///< points of `boundaries` at which two distances are equal to rounding
};

/// For surfaces in R^3; `sources` d x m, projected onto the surface as by PathSolver. Labels and distances as of
/// DistanceSolver where geodesics can be followed, else as the nearest cell's of a march. Boundary points lie on the
/// edges of the mesh, brought onto the surface and bisected until the label changes within rounding; points where three
/// parts meet are good to a part of a triangle. Throws InvalidArgument in other dimensions, and what DistanceSolver
/// throws.
[[nodiscard]] VoronoiResult geodesic_voronoi(const Surface& surface, const PointsIn& sources,
                                             const DistanceOptions& options = {}, const Context& context = {});

}  // namespace taut
