#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "surface/formula/expression.hpp"
#include "surface/formula/names.hpp"

namespace taut::detail {

/// Reads the lines of a scene (see `parse_scene`) into `graph` and `names`; returns the components of the last one.
/// Throws ParseError, which names the line.
[[nodiscard]] std::vector<NodeId> parse_scene_lines(std::string_view text,
                                                    const std::map<std::string, double>& parameters, Names& names,
                                                    Graph& graph);

}  // namespace taut::detail
