#pragma once

#include <vector>

#include "march/start_paths.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// Ways made of the first part of one geodesic and the second part of another that comes near it on the way, no longer
/// than `most` by estimate, shortest first. Where a way round one hill is followed by a way round another, three of the
/// four combinations may be known: the fourth is found here. Those that keep near a known geodesic are left out.
[[nodiscard]] std::vector<StartPath> splices(const Surface& surface, const std::vector<PathCandidate>& geodesics,
                                             double most);

}  // namespace taut::detail
