#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Ways from p to q (d each, on the surface) along the geodesics of a 2-surface (d - k = 2): rays leave p to all sides,
/// each followed to where it comes nearest to q on the sheet of q, and a straight walk from there. They turn round rims
/// that are too sharp for cells and steps. Shortest first; none where no ray within the budget passes near q, and of
/// any other dimension.
[[nodiscard]] std::vector<Points> ways_by_rays(const Surface& surface, const Vector& p, const Vector& q,
                                               const Context& context);

}  // namespace taut::detail
