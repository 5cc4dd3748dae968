#pragma once

#include <cstdint>
#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

enum class MarchMethod {
  convergent,  ///< upwind updates on the projected points of all 3^d - 1 neighbours; second order, the default
  axis,        ///< the paper's: fast marching between cell centres, axis by axis; biased on the crossed cells alone,
               ///< converges in an envelope of more layers (docs/march.md)
  dijkstra,  ///< shortest walk over the projected points of cells that touch, in an envelope over their centres; biased
};

/// Distances from one or several sources at the projected points of cells. A value; it belongs to the cells it was
/// marched on (lazy cells may have grown since: cells beyond `distance.size()` were not reached).
struct DistanceField {
  MarchMethod method = MarchMethod::convergent;
  /// Does distance(i) belong to the centre of cell i (axis, and dijkstra in an envelope) rather than to cells.point(i).
  bool at_centres = false;
  /// n: distance at the cells, model units; infinity where not reached, or not needed for the target.
  Vector distance;
  /// d x n: unit tangent at cells.point(i) in which the distance grows, i.e. the direction in which the shortest path
  /// from the source arrives. Convergent method only (else d x 0); zero where not reached.
  Points gradient;
  /// n: which column of `sources` is the nearest one; -1 where not reached.
  std::vector<std::int32_t> nearest_source;
  Points sources;         ///< d x m: the sources, as given
  Points source_normals;  ///< (d k) x m: orthonormal bases of the normal spaces there
  Index num_reached = 0;  ///< cells with a finite distance
  /// The marched distance at `MarchOptions::target`; infinity when it was not reached, NaN when none was given.
  double target_distance = 0;
};

/// Distances at arbitrary surface points (d x n), to the field's own accuracy: the update of the march itself, made at
/// x from the cells around it. Exactly 0 at a source. Infinity where no reached cell lies around a point, NaN for a
/// point that is not finite or singular. Convergent fields; for the others the shortest of the ways straight from a
/// cell.
[[nodiscard]] Vector distance_at(const Surface& surface, const SurfaceCells& cells, const DistanceField& field,
                                 const PointsIn& x);

}  // namespace taut
