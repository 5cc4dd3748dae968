#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

struct Ways {
  /// Which ways were looked for.
  enum class Sought {
    any,        ///< one that arrives
    at_random,  ///< several, in random directions
    all,        ///< all there are
  };
  std::vector<Points> paths;  ///< d x m each
  Sought sought = Sought::any;
};

/// Ways from p to q (d each, on the surface) to start a correction from, where cells do not reach: the dimension is too
/// high for them, or the surface too thin. On a surface of dimension 1, those along the curve. Else a straight walk
/// from either end; where the surface has samples, the way over their neighbourhood graph; on one of dimension 2, along
/// geodesics to all sides; with `all`, or where nothing leads there yet, detours to all sides; and a random search from
/// both ends. None when nothing was found: a strong
/// hint, but no proof, that the points lie on different components.
[[nodiscard]] Ways find_ways(const Surface& surface, const Vector& p, const Vector& q, bool all,
                             const Context& context);

}  // namespace taut::detail
