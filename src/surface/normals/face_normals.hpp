#pragma once

#include <optional>

#include "surface/rbf/cloud_geometry.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// Each column to length 1; columns without a direction to zero.
void normalise_columns(Points& normals);

/// The corners' angle-weighted mean of the face normals at each merged point (zero where there is no face), a closed
/// mesh that is wound inside out turned. None where faces are not wound consistently; `context.note` tells of both.
[[nodiscard]] std::optional<Points> face_normals(const PointCloud& cloud, const MergedPoints& merged,
                                                 const Context& context);

}  // namespace taut::detail
