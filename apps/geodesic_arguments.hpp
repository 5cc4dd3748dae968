#pragma once

#include "cell_arguments.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "load_surface.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/path.hpp"

namespace taut::app {

/// What every command takes that answers by shortest paths: a surface, cells, a march and a tolerance.
struct GeodesicArguments {
  CommonArguments common;
  SurfaceArguments surface;
  PathOptions options;

  void add_to(CLI::App& command) {
    surface.add_to(command);
    command.add_option("--tol", options.tolerance, "relative length tolerance")
        ->check(number_between(1e-13, 1e-3))
        ->capture_default_str();
    add_cell_options(command, options.cell, options.grid);
    add_march_option(command, options.march);
    common.add_to(command);
  }

  /// Reads the surface, and the points of --samples where they are seeds.
  [[nodiscard]] Surface load(const Context& context) {
    const Surface loaded = load_surface(surface, context);
    options.seeds = read_seeds(surface, loaded, options.grid, context);
    return loaded;
  }

  [[nodiscard]] DistanceOptions distance_options() const {
    return {.tolerance = options.tolerance,
            .grid = options.grid,
            .cell = options.cell,
            .seeds = options.seeds,
            .march = options.march};
  }
};

}  // namespace taut::app
