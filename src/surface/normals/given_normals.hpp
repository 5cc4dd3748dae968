#pragma once

#include <optional>

#include "surface/normals/neighbour_graph.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// The cloud's own normals at the merged points, unit (zero where unknown), once they have been compared with the
/// points. None where they do not stand on the sheet the points make (a constant direction everywhere, say). Where some
/// disagree in sign with their neighbours they are turned to the side that most of their piece has; where there is no
/// majority, outwards. `context.note` tells of both.
[[nodiscard]] std::optional<Points> checked_normals(const PointCloud& cloud, const MergedPoints& merged,
                                                    const KdTree& tree, Index neighbours, const Context& context);

}  // namespace taut::detail
