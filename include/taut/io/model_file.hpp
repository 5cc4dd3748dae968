#pragma once

#include <filesystem>

#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"

namespace taut {

/// Writes a fitted model to a `.taut` file, which appears whole or not at all. `read_model` gives back every bit.
/// Throws IoError with the system's reason.
void write_model(const std::filesystem::path& path, const FitModel& model);

/// Reads what `write_model` wrote, on any machine. Throws IoError for a file that is no model, of another version, cut
/// short or damaged anywhere (it ends with a checksum); nothing is allocated on a count's word alone.
[[nodiscard]] FitModel read_model(const std::filesystem::path& path, const Context& context = {});

}  // namespace taut
