#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "height_argument.hpp"
#include "network_argument.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/surface.hpp"
#include "volume_argument.hpp"

namespace taut::app {

/// SURFACE and the options that say what it is; every command has them.
struct SurfaceArguments {
  std::string surface;
  std::optional<Index> dim;
  std::string variables;  // "theta,phi"
  std::vector<std::string> parameters;
  std::vector<std::string> domain;
  std::string box;
  std::string samples;  // file
  FitOptions fit;
  VolumeArguments volume;
  HeightArguments height;
  NetworkArguments network;

  void add_to(CLI::App& command);
};

/// --fit, --smooth, --samples-max and --support: how a cloud is fitted.
void add_fit_options(CLI::App& command, FitOptions& options);

/// Reads a cloud and fits it. What is wrong with the points names the file, as an IoError.
[[nodiscard]] FitModel fit_file(const std::string& path, const FitOptions& options, const Context& context,
                                std::optional<Index> dim = {});

/// The surface, from a formula, a point cloud (fitted), a volume or a `.taut` model. Throws what the readers throw.
[[nodiscard]] Surface load_surface(const SurfaceArguments& arguments, const Context& context);

/// True when SURFACE names a file rather than spelling a formula.
[[nodiscard]] bool names_a_file(const std::string& surface);

}  // namespace taut::app
