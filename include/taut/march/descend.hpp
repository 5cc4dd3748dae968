#pragma once

#include "taut/march/distance_field.hpp"

namespace taut {

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
