#pragma once

#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// Looks for samples among whose nearest some face the other way, and asks whether F keeps the two sheets apart there.
/// `normals`: unit, those F was fitted to; `tree`: over `points`. In the plane and in space; in more dimensions nothing
/// is found.
[[nodiscard]] MergedSheets find_bridged_gap(const Points& points, const Points& normals, const KdTree& tree,
                                            const ImplicitFunction& function, const Context& context);

}  // namespace taut::detail
