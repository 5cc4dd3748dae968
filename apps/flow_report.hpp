#pragma once

#include <nlohmann/json.hpp>

#include "taut/curve/flow.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

/// The `flow` entry of a path's JSON (docs/json.md).
[[nodiscard]] nlohmann::ordered_json flow_json(const FlowSummary& summary);

/// The same for a person.
[[nodiscard]] std::vector<SceneFact> flow_facts(const FlowSummary& summary);

}  // namespace taut::app
