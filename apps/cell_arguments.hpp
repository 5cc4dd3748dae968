#pragma once

#include <CLI/App.hpp>

#include <string>
#include <vector>

#include "load_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// --cell and --grid: the cells around a surface.
void add_cell_options(CLI::App& command, double& cell, GridMethod& grid);

/// --march and --envelope: the distances on them.
void add_march_option(CLI::App& command, MarchMethod& march);
void add_envelope_option(CLI::App& command, Index& envelope);

/// Throws UsageError where an envelope is asked for that no march goes through.
void check_envelope_usage(MarchMethod march, Index envelope);

/// The points of --samples where they are the seeds of Algorithm II (formulas in as many dimensions as all cells are
/// made in), else d x 0. Throws UsageError where they would have no effect.
[[nodiscard]] Points read_seeds(const SurfaceArguments& arguments, const Surface& surface, GridMethod grid,
                                const Context& context);

/// Throws UsageError naming the first of the options that was given, and why it has no effect.
void refuse_without_effect(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason);

}  // namespace taut::app
