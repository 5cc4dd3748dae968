#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Ways from p to q (d each, on the surface) to start a correction from, where the dimension is too high for cells;
/// each d x m. A straight walk from either end; where the surface has samples, the way over their neighbourhood graph;
/// and where neither leads anywhere a random search from both ends. None when nothing was found: a strong hint, but no
/// proof, that the points lie on different components.
[[nodiscard]] std::vector<Points> find_ways(const Surface& surface, const Vector& p, const Vector& q,
                                            const Context& context);

}  // namespace taut::detail
