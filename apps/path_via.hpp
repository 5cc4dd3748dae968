#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

/// What a path through points adds to the JSON of a path: "via" and "legs".
void add_legs(const ViaResult& path, nlohmann::ordered_json& json);

/// The same for a person: a line for every leg.
void add_legs(const ViaResult& path, std::vector<SceneFact>& facts);

}  // namespace taut::app
