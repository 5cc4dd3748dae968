#pragma once

#include <vector>

#include "surface/local_fit/patch_solve.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// How far around each sample there is surface: far enough that the holes between samples of one sheet are filled, by
/// the spacing around it and, for a mesh, by its longest edge, but less than half of the gap to the next sheet that
/// faces the same way (see default_support_radius). `spacing`: n; `faces`: indices as in `merged_to`.
[[nodiscard]] Vector support_radii(OrientedSamples samples, const KdTree& tree, const Vector& spacing,
                                   const Eigen::Matrix3Xi& faces, const std::vector<Index>& merged_to,
                                   const Context& context);

/// Which samples lie where the sampled sheet ends, or at a hole: those whose neighbours within the sheet lie to one
/// side. A few others are taken for such at random samples. n.
[[nodiscard]] std::vector<bool> find_rim(OrientedSamples samples, const KdTree& tree, const Context& context);

}  // namespace taut::detail
