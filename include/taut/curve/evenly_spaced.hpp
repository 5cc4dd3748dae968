#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Arc length from the first point to each point of a smooth curve that is given by points close together (d x m),
/// model units. Each chord counts as the circular arc that its neighbours say, so the error falls with the fourth power
/// of the spacing; where the curve turns by more than 0.3 rad from one chord to the next it is taken for a corner.
[[nodiscard]] Vector arc_lengths(const PointsIn& curve);

/// n points (n >= 2) at equal arc lengths along the curve (d x m), the first and the last its ends; each is projected
/// onto the surface. Throws InvalidArgument for n < 2 and for a curve of less than two points.
[[nodiscard]] Points evenly_spaced(const Surface& surface, const PointsIn& curve, Index n);

}  // namespace taut
