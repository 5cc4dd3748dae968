#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A start path without cells, for dimensions where there would be too many: from p in small steps along the tangent
/// space towards q, each projected back onto the surface. d x m from p to q, or d x 0 where the walk gets stuck (q
/// straight behind the surface, a singular point). p and q (d) lie on the surface.
[[nodiscard]] Points walk_towards(const Surface& surface, const VectorIn& p, const VectorIn& q);

}  // namespace taut::detail
