// taut info: what a surface is, before asking it anything.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "cell_arguments.hpp"
#include "commands.hpp"
#include "load_surface.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/query/surface_summary.hpp"
#include "taut/surface/curvature.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

struct InfoArguments {
  CommonArguments common;
  SurfaceArguments surface;
  SummaryOptions options;
  std::string at;
  bool json = false;
};

/// Curvatures at one point.
ExitCode tell_curvature(const InfoArguments& arguments, const Surface& surface) {
  const SurfaceCurvature found = curvature_at(surface, parse_point(arguments.at, "--at", surface));
  if (arguments.json) {
    nlohmann::ordered_json json;
    json["command"] = "info";
    json["point"] = vector_json(found.point);
    json["normal"] = vector_json(found.normal);
    json["gaussian_curvature"] = found.gaussian;
    json["mean_curvature"] = found.mean;
    json["principal_curvatures"] = vector_json(found.principal);
    json["principal_directions"] = points_json(found.directions);
    std::cout << json.dump() << "\n";
    return kDone;
  }
  std::vector<SceneFact> facts = {{"point", vector_text(found.point)},
                                  {"normal", vector_text(found.normal)},
                                  {"gaussian", fmt::format("{:.15g}", found.gaussian)},
                                  {"mean", fmt::format("{:.15g}", found.mean)}};
  constexpr Index kShown = 10;
  for (Index i = 0; i < std::min(found.principal.size(), kShown); ++i) {
    facts.push_back(
        {"principal", fmt::format("{:.15g} along {}", found.principal(i), vector_text(found.directions.col(i)))});
  }
  std::cout << facts_text(facts);
  return kDone;
}

}  // namespace

Run add_info_command(CLI::App& app) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App& command = *app.add_subcommand("info", "what a surface is: dimension, extent, cells, components");
  arguments->surface.add_to(command);
  add_cell_options(command, arguments->options.cell, arguments->options.grid);
  add_envelope_option(command, arguments->options.envelope);
  command.add_option("--at", arguments->at, "curvatures at this point instead: 1,0,0 or @17");
  command.add_flag("--json", arguments->json, "one JSON object on stdout");
  arguments->common.add_to(command);
  return [arguments] {
    const Context context = terminal_context(arguments->common.terminal);
    const Surface surface = load_surface(arguments->surface, context);
    if (!arguments->at.empty()) return tell_curvature(*arguments, surface);
    SummaryOptions options = arguments->options;
    options.seeds = read_seeds(arguments->surface, surface, options.grid, context);
    const SurfaceSummary summary = summarise(surface, options, context);
    clear_progress();
    std::cout << (arguments->json ? summary_json(summary).dump() + "\n" : facts_text(summary_facts(summary)));
    return kDone;
  };
}

}  // namespace taut::app
