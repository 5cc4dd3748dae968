#pragma once

#include <filesystem>

#include "taut/core/context.hpp"
#include "taut/surface/formula.hpp"

namespace taut {

/// The surface that a clause file (.vm) describes, see `parse_clauses`. Throws IoError for a file that cannot be read
/// or has a bad clause (which it names by its line), InvalidArgument for the options.
[[nodiscard]] Surface read_clauses(const std::filesystem::path& path, const FormulaOptions& options = {},
                                   const Context& context = {});

}  // namespace taut
