#pragma once

#include "taut/core/context.hpp"
#include "walk/surface_walker.hpp"

namespace taut::detail {

/// The shortest way from p to q over a nearest-neighbour graph of points on or near the surface (`samples`, d x n), its
/// edges tried by walking. d x m, or d x 0 when the graph does not join them.
[[nodiscard]] Points search_by_samples(SurfaceWalker& walker, const Vector& p, const Vector& q, const PointsIn& samples,
                                       const Context& context);

}  // namespace taut::detail
