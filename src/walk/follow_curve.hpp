#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The ways from p to q (d each, on the surface) along a surface of dimension 1, d x m each: one or two on a closed
/// curve, one at most on an open one. Rays from p in both directions, up to where they pass q, return to p, end, or are
/// some thousand times as long as p and q are apart.
[[nodiscard]] std::vector<Points> follow_curve(const Surface& surface, const Vector& p, const Vector& q,
                                               const Context& context);

}  // namespace taut::detail
