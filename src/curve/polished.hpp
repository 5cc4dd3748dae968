#pragma once

#include <limits>

#include "taut/core/context.hpp"
#include "taut/curve/newton.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The geodesic through the points of one that is known already (d x m, its ends on the surface), as a spectral curve
/// that is as exact as rounding allows: for its end directions, and what is carried along it.
[[nodiscard]] NewtonResult polished(const Surface& surface, const PointsIn& points, const Context& context);

/// Where a geodesic leaves its start and how it arrives.
struct EndDirections {
  Vector departure, arrival;                               ///< d: unit tangents; NaN where there are none
  double miss = std::numeric_limits<double>::quiet_NaN();  ///< of a ray that leaves so, at the end, model units
};

/// Of a polished geodesic: its tangents, corrected by rays that are aimed at its end. Directions that a curve of 1e-13
/// in length gives are good to some 1e-9 only; rays bring them to rounding times the spread of rays.
[[nodiscard]] EndDirections end_directions(const Surface& surface, const NewtonResult& geodesic,
                                           const Context& context);

}  // namespace taut::detail
