#pragma once

#include "taut/core/types.hpp"

namespace taut::paper {

// Polylines, d x m.

[[nodiscard]] double polyline_length(const PointsIn& line);
/// Largest distance of a point of `a` from the polyline `b`, or of one of `b` from `a`: how far apart two curves run.
[[nodiscard]] double distance_between(const PointsIn& a, const PointsIn& b);
/// The point at that arc length from the start.
[[nodiscard]] Vector point_along(const PointsIn& line, double length);

}  // namespace taut::paper
