#pragma once

#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/fit.hpp"

namespace taut::detail {

/// Looks for samples that are taken for one noisy sheet and lie in two layers: the faces of a plate, blurred by noise
/// of up to some 0.35 of their gap. `normals`: unit, those of the fit; samples that face the other way count as another
/// sheet. `tree`: over `points`. In the plane and in space; in more dimensions nothing is found. The gap is that of the
/// layers, model units.
[[nodiscard]] MergedSheets find_layered_noise(const Points& points, const Points& normals, const KdTree& tree,
                                              const Context& context);

}  // namespace taut::detail
