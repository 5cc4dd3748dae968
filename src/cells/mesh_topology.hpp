#pragma once

#include <vector>

#include "taut/core/mesh.hpp"

namespace taut::detail {

/// Gives every fan of triangles round a vertex a vertex of its own, so that a mesh whose edges are manifold is manifold
/// at its vertices too. Returns, for each vertex added behind the old ones, the one it repeats.
std::vector<int> part_fans(Index num_vertices, Eigen::Matrix3Xi& faces);

/// Drops the vertices no face uses and renumbers the faces. Returns the old number of each vertex kept, in order.
std::vector<int> drop_unused_vertices(Index num_vertices, Eigen::Matrix3Xi& faces);

}  // namespace taut::detail
