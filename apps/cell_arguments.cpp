#include "cell_arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "checks.hpp"
#include "help_format.hpp"
#include "points_argument.hpp"
#include "taut/io/read_points.hpp"

namespace taut::app {

void add_cell_options(CLI::App& command, double& cell, GridMethod& grid) {
  const OptionGroup group(command, "Cells and marching");
  command.add_option("--cell", cell, "grid cell size (default: chosen)")->check(positive_number());
  command.add_option("--grid", grid, "cells by subdivide (Algorithm I) or grow (Algorithm II)")
      ->transform(one_of<GridMethod>({{"subdivide", GridMethod::subdivide}, {"grow", GridMethod::grow}}));
}

void add_march_option(CLI::App& command, MarchMethod& march) {
  const OptionGroup group(command, "Cells and marching");
  command.add_option("--march", march, "distances on the cells: convergent, axis (the paper's) or dijkstra")
      ->transform(one_of<MarchMethod>(
          {{"convergent", MarchMethod::convergent}, {"axis", MarchMethod::axis}, {"dijkstra", MarchMethod::dijkstra}}));
}

void add_envelope_option(CLI::App& command, Index& envelope) {
  const OptionGroup group(command, "Cells and marching");
  static constexpr long long kMostLayers = 1000;
  const auto translate = [](std::string& text) -> std::string {
    if (text == "auto") {
      text = std::to_string(kEnvelopeByLaw);
      return "";
    }
    long long layers = 0;
    const bool is_whole = CLI::detail::lexical_cast(text, layers);
    return is_whole && layers >= 0 && layers <= kMostLayers
               ? ""
               : fmt::format("'{}' is neither auto nor a whole number from 0 to {}", text, kMostLayers);
  };
  command
      .add_option("--envelope", envelope,
                  "march axis or dijkstra in so many layers of cells around those crossed; auto: by the error bound")
      ->transform(CLI::Validator(translate, "0..1000 or auto"));
}

void check_envelope_usage(MarchMethod march, Index envelope) {
  if (envelope != 0 && march == MarchMethod::convergent) {
    throw UsageError("--envelope goes with --march axis or dijkstra, which march between cell centres");
  }
}

Points read_seeds(const SurfaceArguments& arguments, const Surface& surface, GridMethod grid, const Context& context) {
  if (arguments.samples.empty() || surface.samples() != nullptr) return Points(surface.dim(), 0);
  if (grid != GridMethod::grow) {
    throw UsageError(
        "--samples are what the cells of a formula grow from: give --grid grow, too (in up to 6 dimensions)");
  }
  return read_points(arguments.samples, surface.dim(), context);
}

void refuse_without_effect(const CLI::App& command, const std::vector<std::string>& options,
                           const std::string& reason) {
  for (const std::string& option : options) {
    if (command.count(option) > 0) throw UsageError(fmt::format("{} has no effect: {}", option, reason));
  }
}

}  // namespace taut::app
