#pragma once

#include "taut/curve/geodesic.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// How far a polyline (d x m) is from being a geodesic, measured on it as it is, corners and all. `surface`: the
/// largest |J^+ F| (k = 1: |F| / |grad F|) at its corners and at seven places between each two; NaN where F has no
/// value there. `geodesic_curvature`: the largest discrete |k_g| at a corner, the part of 2 (t2 - t1) / (l1 + l2)
/// tangent to the level set there, t and l the unit tangents and lengths of the two sides; 0 without corners.
[[nodiscard]] CurveResidual polyline_residual(const Surface& surface, const PointsIn& nodes);

}  // namespace taut::detail
