#pragma once

#include <filesystem>

#include "taut/core/context.hpp"
#include "taut/surface/formula.hpp"

namespace taut {

/// The surface that a scene file (.scene) describes, see `parse_scene`. Throws IoError for a file that cannot be read
/// or has a bad line (which it names), InvalidArgument for the options.
[[nodiscard]] Surface read_scene(const std::filesystem::path& path, const FormulaOptions& options = {},
                                 const Context& context = {});

}  // namespace taut
