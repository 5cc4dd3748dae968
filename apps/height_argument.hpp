#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// --heights, --pixel, --z-scale and --no-data: what a picture or an array means as a terrain.
struct HeightArguments {
  bool heights = false;
  std::string pixel;  // "0.5" or "0.5,0.4"
  std::optional<double> z_scale;
  std::optional<double> no_data;

  void add_to(CLI::App& command);
  /// The first of these options that was given; null when none was.
  [[nodiscard]] const char* given() const;
};

/// Is the file a picture, or an array and --heights given.
[[nodiscard]] bool is_height_file(const std::string& file, const HeightArguments& arguments);

/// The surface over a height field. Throws UsageError for options, what the readers throw, and IoError, which names the
/// file, for heights that make no surface.
[[nodiscard]] Surface load_heights(const std::string& file, const HeightArguments& arguments, const Context& context);

}  // namespace taut::app
