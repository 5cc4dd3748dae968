#pragma once

#include <memory>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// What was found along a border on cells of one size.
struct BorderAnswer {
  enum class Kind {
    path,    ///< `result` is ok
    coarse,  ///< there is a way over the cells, but no path of it that stays inside
    none,    ///< no way over the cells stays inside
  };
  Kind kind = Kind::none;
  PathResult result;
};

/// The shortest path from p to q (on the surface) within the surface's domain, along its border where need be: the way
/// over the cells that stays inside, pulled taut (`pull_taut`), and made a geodesic where it touches nothing. Along a
/// border it is known to some 1e-5 of its length, as `length_error` says. Other ways round are not looked for. Surfaces
/// in R^3 (k = 1) with a smooth domain.
[[nodiscard]] BorderAnswer search_along_border(const Surface& surface, const PathOptions& options,
                                               const SurfaceCells& cells, const Vector& p, const Vector& q,
                                               const Context& context);

}  // namespace taut::detail
