#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "taut/core/mesh.hpp"
#include "taut/query/path.hpp"

namespace taut::app {

/// Paths as files hold them.
struct PathLines {
  Polylines lines;  ///< with the arc length from each path's start
  Points normals;   ///< d x all points, unit; none where the surface is no hypersurface
};

/// The points of each path: its own, or `evenly_spaced` many at equal arc lengths if that is not 0.
[[nodiscard]] PathLines path_lines(const Surface& surface, const std::vector<const PathResult*>& paths,
                                   Index evenly_spaced);

/// Puts the points of one path, likewise, into its JSON.
void space_points(const Surface& surface, const PathResult& path, Index evenly_spaced, nlohmann::ordered_json& json);

}  // namespace taut::app
