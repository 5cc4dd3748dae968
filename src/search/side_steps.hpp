#pragma once

#include <vector>

#include "march/start_paths.hpp"
#include "search/ground.hpp"
#include "taut/core/context.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Ways from the source of one field to that of the other on a surface in R^3 that step aside, by a cell to either
/// side, wherever a known way (3 x m) between them passes a sharp bend: past the tip of a spike or across a cleft, ways
/// differ that cells cannot tell apart. Those no longer than `most`. Needs bends and a map.
[[nodiscard]] std::vector<StartPath> side_steps(const Surface& surface, const Ground& ground, const Points& way,
                                                const DistanceField& from_p, const DistanceField& from_q, double most,
                                                const Context& context);

}  // namespace taut::detail
