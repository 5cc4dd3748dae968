#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/query/closed_geodesic.hpp"
#include "taut/query/path.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

struct PolylineRequest {
  std::string file;  ///< a point a line, or any point file
  std::string from;  ///< --from and --to: empty, or the polyline's ends
  std::string to;
};

/// taut path --start: the geodesic in the class of a file's polyline. Messages name the file.
[[nodiscard]] PathResult shorten_polyline(const PolylineRequest& request, const Surface& surface,
                                          const PathOptions& options, const Context& context);

/// taut path --closed: the closed geodesic in the class of a file's loop.
[[nodiscard]] ClosedGeodesic close_polyline(const std::string& file, const Surface& surface, const PathOptions& options,
                                            const Context& context);

/// What a closed geodesic adds to the JSON of a path.
void add_closed(const ClosedGeodesic& loop, nlohmann::ordered_json& json);

/// The same for a person.
void add_closed(const ClosedGeodesic& loop, std::vector<SceneFact>& facts);

}  // namespace taut::app
