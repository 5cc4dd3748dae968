#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The points of a curve (d x n, on the surface, in order) with more of them put in wherever it may cross the border of
/// the surface's domain, by bounds of the domain around each gap: what cuts into the curve, be it smaller than its
/// gaps, has a point inside, down to a millionth of the curve. As given where the domain has no bounds.
[[nodiscard]] Points looks_at_border(const Surface& surface, Evaluator& function, const Points& curve);

}  // namespace taut::detail
