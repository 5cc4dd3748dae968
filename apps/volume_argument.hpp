#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// --iso, --label and --grid-name: what in a volume is the surface.
struct VolumeArguments {
  std::optional<double> iso;
  std::optional<double> label;
  std::string grid_name;

  void add_to(CLI::App& command);
  /// The first of these options that was given; null when none was.
  [[nodiscard]] const char* given() const;
};

/// The level set of a volume file; `smooth` in voxels. Throws UsageError where no level is given, what the readers
/// throw, and IoError, which names the file, for a volume that makes no surface.
[[nodiscard]] Surface load_volume(const std::string& file, const VolumeArguments& arguments,
                                  std::optional<double> smooth, const Context& context);

}  // namespace taut::app
