// taut sample: points spread over a surface, each as far as can be from those before it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cell_arguments.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "input_files.hpp"
#include "load_surface.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/point_sets.hpp"
#include "terminal.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

struct SampleArguments {
  CommonArguments common;
  SurfaceArguments surface;
  Index count = 0;
  std::string from;
  FarthestPointsOptions options;
  std::string out;
};

ExitCode run(SampleArguments arguments) {
  refuse_to_overwrite({arguments.surface.surface}, {arguments.out});
  const Context context = terminal_context(arguments.common.terminal);
  const Surface surface = load_surface(arguments.surface, context);
  arguments.options.seeds = read_seeds(arguments.surface, surface, arguments.options.grid, context);
  const Vector first = arguments.from.empty() ? Vector() : parse_point(arguments.from, "--from", surface);
  const FarthestPoints chosen = farthest_points(surface, first, arguments.count, arguments.options, context);
  clear_progress();
  if (chosen.points.cols() < arguments.count) {
    context.tell(
        fmt::format("{} points are all that the cells hold; a smaller --cell has more", grouped(chosen.points.cols())));
  }
  if (arguments.out.empty()) {
    for (Index j = 0; j < chosen.points.cols(); ++j) {
      std::string line = vector_columns(chosen.points.col(j));
      line.back() = '\n';
      std::cout << line;
    }
    return kDone;
  }
  PointCloud cloud;
  cloud.points = chosen.points;
  write_point_cloud(arguments.out, cloud);
  std::cout << facts_text({{"points", grouped(chosen.points.cols())},
                           {"cover", fmt::format("{:.6g}: none of the surface is farther from one of them, and no two "
                                                 "are nearer to each other (marched)",
                                                 chosen.cover.back())}});
  return kDone;
}

}  // namespace

Run add_sample_command(CLI::App& app) {
  auto arguments = std::make_shared<SampleArguments>();
  CLI::App& command = *app.add_subcommand("sample", "points spread evenly over a surface");
  arguments->surface.add_to(command);
  command.add_option("-n,--number", arguments->count, "how many points")->required()->check(whole_number(1, 10000000));
  command.add_option("--from", arguments->from, "the first one: 1,0,0 or @17 (default: any point)");
  command.add_option("-o,--out", arguments->out,
                     "write them to FILE, by extension: .csv .npy .ply .vtp .xyz .json ... (default: lines on stdout)");
  add_cell_options(command, arguments->options.cell, arguments->options.grid);
  arguments->common.add_to(command);
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
