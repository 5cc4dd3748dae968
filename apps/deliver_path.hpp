#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exit_code.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

/// Where a single path goes, and under which name.
struct PathDelivery {
  bool json = false;             ///< JSON on stdout instead of lines for people
  std::vector<std::string> out;  ///< files, by extension
  std::string title;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// Prints the path, writes its files, says on stderr what was wrong with it, and knows the exit code.
[[nodiscard]] ExitCode deliver_path(const PathDelivery& delivery, const Surface& surface, const PathResult& path,
                                    const nlohmann::ordered_json& json, const std::vector<SceneFact>& facts,
                                    const Context& context);

}  // namespace taut::app
