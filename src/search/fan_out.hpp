#pragma once

#include <vector>

#include "march/start_paths.hpp"
#include "search/ground.hpp"
#include "taut/core/context.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Ways from p (3), around which a surface in R^3 bends within a cell, to the source of a field: geodesics in all
/// directions as far as cells can tell ways apart again, and on from there down the field. One start for each direction
/// in which that is shorter than in those beside it, if it is no longer than `most`, shortest first. Near the apex of a
/// cone or the tip of a spike cells do not say which side of it the shortest way takes. Needs bends and a map.
[[nodiscard]] std::vector<StartPath> fan_out(const Surface& surface, const Ground& ground, const Vector& p,
                                             const DistanceField& field, double most, const Context& context);

}  // namespace taut::detail
