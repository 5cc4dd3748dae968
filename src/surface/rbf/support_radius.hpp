#pragma once

#include <vector>

#include "surface/rbf/kd_tree.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// True when every edge of the faces (indices as in `merged_to`) is shared by exactly two of them.
[[nodiscard]] bool is_watertight(const Eigen::Matrix3Xi& faces, const std::vector<Index>& merged_to);

/// How far from its samples a surface may reach: wide enough that the holes between samples of one sheet stay filled,
/// but below half of the gap to the next sheet that faces the same way (the turns of a roll), for midway between such
/// sheets F changes sign once more where there is no surface. `points`, `normals`: d x n, distinct, unit.
[[nodiscard]] double default_support_radius(const Points& points, const Points& normals, const KdTree& tree);

/// That bound alone: infinite where no such sheets were found near.
[[nodiscard]] double support_between_sheets(const Points& points, const Points& normals, const KdTree& tree,
                                            const Vector& spacing);

}  // namespace taut::detail
