#pragma once

#include "taut/march/distance_field.hpp"

namespace taut {

/// The polyline (d x m, m >= 2) from `target` down the field to the nearest source, returned from source to target.
/// Both ends are exact; the points between lie near the surface (within a small part of a cell), about half a cell
/// apart, and the distance falls strictly from target to source, so the line has no loops. Its length is close to the
/// distance. p = q gives two equal points. Empty (d x 0) when no reached cell lies around the target. Throws
/// InvalidArgument when `target` has the wrong dimension or is not finite.
[[nodiscard]] Points descend(const Surface& surface, const SurfaceCells& cells, const DistanceField& field,
                             const VectorIn& target);

}  // namespace taut
