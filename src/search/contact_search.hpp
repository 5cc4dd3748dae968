#pragma once

#include <vector>

#include "march/start_paths.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Can paths on this surface be followed along its borders by `search_contacts`: it is cut by a domain, has two
/// dimensions or more, and is none of those in R^3 that FacetSearch and `search_along_border` answer for.
[[nodiscard]] bool has_contacts(const Surface& surface, const PathOptions& options);

/// The shortest path from p to q (on the surface and inside its domain) among those that each of these starts is pulled
/// taut to (ContactChain); the starts may run through what is forbidden, and no path is shorter than the length of its
/// start. Where none is found, `status` is left_domain, and the obstacle says why. Ways round the other side of an
/// obstacle are tried only where a start goes there.
[[nodiscard]] PathResult search_contacts(const Surface& surface, const PathOptions& options,
                                         const std::vector<StartPath>& starts, const Vector& p, const Vector& q,
                                         const Context& context);

}  // namespace taut::detail
