// taut info: what a surface is, before asking it anything.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cell_arguments.hpp"
#include "commands.hpp"
#include "load_surface.hpp"
#include "report.hpp"
#include "taut/query/surface_summary.hpp"

namespace taut::app {
namespace {

struct InfoArguments {
  CommonArguments common;
  SurfaceArguments surface;
  SummaryOptions options;
  bool json = false;
};

}  // namespace

Run add_info_command(CLI::App& app) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App& command = *app.add_subcommand("info", "what a surface is: dimension, extent, cells, components");
  arguments->surface.add_to(command);
  add_cell_options(command, arguments->options.cell, arguments->options.grid);
  add_envelope_option(command, arguments->options.envelope);
  command.add_flag("--json", arguments->json, "one JSON object on stdout");
  arguments->common.add_to(command);
  return [arguments] {
    const Context context = terminal_context(arguments->common.terminal);
    const Surface surface = load_surface(arguments->surface, context);
    SummaryOptions options = arguments->options;
    options.seeds = read_seeds(arguments->surface, surface, options.grid, context);
    const SurfaceSummary summary = summarise(surface, options, context);
    clear_progress();
    std::cout << (arguments->json ? summary_json(summary).dump() + "\n" : facts_text(summary_facts(summary)));
    return kDone;
  };
}

}  // namespace taut::app
