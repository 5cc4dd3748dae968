#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
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

struct MarchOptions {
  MarchMethod method = MarchMethod::convergent;
  /// Stop as soon as the distance at this point (d, on the surface) is final.
  std::optional<Vector> target = std::nullopt;
  /// Leave out what lies farther away than this, model units, >= 0.
  double radius = std::numeric_limits<double>::infinity();
  /// Leave out cells that no path to the target, if there is one, of at most this length leads through, model units.
  /// Convergent marches only.
  double longest = std::numeric_limits<double>::infinity();
};

/// Marches distances from `sources` (d x m surface points, anywhere in the cells) over the cells; lazy cells are grown
/// only where the front passes. Cells that cannot be reached without stepping from one sheet of the surface to another
/// keep the distance infinity: refine the cells then.
///
/// Properties: 0 at a source; distance >= |p - q|; with several sources the minimum of the single fields; the same
/// bits for the same input. Accuracy: docs/measured/march.md. Cost: O(N 3^d + N log N); (d + 3) doubles a cell.
/// Throws InvalidArgument when a source or target has the wrong dimension, is not finite, no cell lies around a
/// source, or the radius is negative; SingularPoint when the surface is singular there; OutOfMemory, Cancelled.
[[nodiscard]] DistanceField march(const Surface& surface, SurfaceCells& cells, const PointsIn& sources,
                                  const MarchOptions& options = {}, const Context& context = {});

/// The polyline (d x m, m >= 2) from `target` down the field to the nearest source, returned from source to target.
/// Both ends are exact; the distance falls strictly from target to source, so the line has no loops. p = q gives two
/// equal points. Empty (d x 0) when no reached cell lies around the target. Throws InvalidArgument when `target` has
/// the wrong dimension or is not finite. What lies between the ends depends on the march:
/// - convergent: points near the surface (within a small part of a cell), about half a cell apart, against the
///   gradient; its length is close to the distance;
/// - dijkstra: the projected points of the cells that were walked; its length is close to the distance;
/// - axis, and dijkstra in an envelope (DistanceField::at_centres): the centres of cells, each touching the next: the
///   path on the grid, off the surface, in the directions of the 3^d - 1 neighbours only.
[[nodiscard]] Points descend(const Surface& surface, const SurfaceCells& cells, const DistanceField& field,
                             const VectorIn& target);

}  // namespace taut
