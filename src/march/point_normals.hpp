#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Orthonormal bases of the normal spaces at surface points x (d x n): (d k) x n, a d x k basis a column. A column is
/// NaN where the Jacobian is not finite or loses rank.
[[nodiscard]] Points normals_at(const Surface& surface, const PointsIn& x);

}  // namespace taut::detail
