#pragma once

#include <vector>

#include "strata/bordered_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// A polyline pulled taut over a surface within its domain, to some digits: where it touches which border.
struct TautString {
  Points points;              ///< d x n, on the surface, about evenly spaced
  std::vector<int> touching;  ///< one a point: the border it is pressed against; BorderedSurface::kFree: none
};

/// Pulls `start` (d x m, from end to end, near the surface; it may run through what is forbidden) taut, as a polyline
/// of `parts` parts. The ends stay.
[[nodiscard]] TautString pull_string(BorderedSurface& surface, const Points& start, Index parts,
                                     const Context& context);

}  // namespace taut::detail
