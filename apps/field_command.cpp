// taut field: distances from sources to everywhere, or to given points.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cell_arguments.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "load_surface.hpp"
#include "output.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_points.hpp"
#include "taut/query/field.hpp"
#include "taut/query/path.hpp"

namespace taut::app {
namespace {

struct FieldArguments {
  CommonArguments common;
  SurfaceArguments surface;
  std::vector<std::string> from;
  std::string at;
  FieldOptions options;
  double tolerance = 1e-9;
  FileArguments files;
};

Points parse_sources(const std::vector<std::string>& texts, const Surface& surface) {
  Points sources(surface.dim(), static_cast<Index>(texts.size()));
  for (std::size_t j = 0; j < texts.size(); ++j) {
    sources.col(static_cast<Index>(j)) = parse_point(texts[j], "--from", surface);
  }
  return sources;
}

/// Exact distances at given points: a corrected path each, the shortest over the sources.
ExitCode distances_at(const FieldArguments& arguments, const Surface& surface, const Points& sources,
                      const Context& context) {
  const Points at = read_points(arguments.at, surface.dim());
  PathSolver solver(surface,
                    {.march = arguments.options.march,
                     .grid = arguments.options.grid,
                     .cell = arguments.options.cell,
                     .seeds = arguments.options.seeds,
                     .envelope = arguments.options.envelope,
                     .tolerance = arguments.tolerance},
                    context);
  std::vector<PathResult> best;
  for (Index s = 0; s < sources.cols(); ++s) {
    std::vector<PathResult> found = solver.solve_from(sources.col(s), at);
    if (best.empty()) {
      best = std::move(found);
      continue;
    }
    for (std::size_t j = 0; j < best.size(); ++j) {
      const bool better =
          found[j].status == Status::ok && (best[j].status != Status::ok || found[j].length < best[j].length);
      if (better) best[j] = std::move(found[j]);
    }
  }
  clear_progress();
  bool all_ok = true;
  for (const PathResult& result : best) {
    if (result.status != Status::ok) {
      all_ok = false;
      print_error(fmt::format("{} point {}: {}", arguments.at, &result - best.data() + 1, result.message));
    }
    if (result.points.cols() > 0) {
      std::cout << fmt::format("{},{}\n", result.length, result.length_error);
    } else {
      std::cout << "nan,inf\n";
    }
  }
  return all_ok ? kDone : kSomeLinesFailed;
}

ExitCode run(FieldArguments arguments, const CLI::App& command) {
  if (arguments.at.empty() == arguments.files.out.empty()) {
    throw UsageError(
        "give --out FILE for the whole surface, or --at POINTS.csv for given points (see taut field --help)");
  }
  if (arguments.at.empty())
    refuse_without_effect(command, {"--tol"}, "it is for --at, distances to everywhere are marched");
  check_envelope_usage(arguments.options.march, arguments.options.envelope);
  arguments.files.check(OutputKind::mesh);
  const Context context = terminal_context(arguments.common.terminal);
  const Surface surface = load_surface(arguments.surface, context);
  arguments.options.seeds = read_seeds(arguments.surface, surface, arguments.options.grid, context);
  const Points sources = parse_sources(arguments.from, surface);
  if (!arguments.at.empty()) return distances_at(arguments, surface, sources, context);
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument(
        fmt::format("a field is drawn on surfaces in 3 dimensions, this one lies in {} with {} "
                    "equation{}; use --at POINTS.csv",
                    surface.dim(), surface.codim(), surface.codim() == 1 ? "" : "s"));
  }
  const FieldResult field = marched_field(surface, sources, arguments.options, context);
  clear_progress();
  const Vector& distance = field.mesh.scalars.front().values;
  Index reached = 0;
  double farthest = 0;
  for (const double u : distance) {
    if (!std::isfinite(u)) continue;
    ++reached;
    farthest = std::max(farthest, u);
  }
  const std::vector<SceneFact> facts = {
      {"cells", cells_text(field.num_cells, field.cell, field.num_layers)},
      {"reached", fmt::format("{} of {} vertices", grouped(reached), grouped(distance.size()))},
      {"farthest", fmt::format("{:.6g}", farthest)}};
  write_mesh_files(arguments.files, {.surface = surface,
                                     .mesh = field.mesh,
                                     .marks = sources,
                                     .facts = facts,
                                     .title = "Distances on " + picture_title(arguments.surface.surface)});
  std::cout << facts_text(facts);
  return kDone;
}

}  // namespace

Run add_field_command(CLI::App& app) {
  auto arguments = std::make_shared<FieldArguments>();
  CLI::App& command = *app.add_subcommand("field", "distances from a source to everywhere");
  arguments->surface.add_to(command);
  command.add_option("--from", arguments->from, "a source: 1,0,0 or @17 (repeatable: the nearest one counts)")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--at", arguments->at, "points, one a line: writes distance,error for each, exact to --tol");
  command.add_option("--tol", arguments->tolerance, "relative tolerance of distances --at points")
      ->check(number_between(1e-13, 1e-3))
      ->capture_default_str();
  add_cell_options(command, arguments->options.cell, arguments->options.grid);
  add_march_option(command, arguments->options.march);
  add_envelope_option(command, arguments->options.envelope);
  arguments->files.add_to(command, OutputKind::mesh, "the surface with marched distances,");
  arguments->common.add_to(command);
  return [arguments, &command] { return run(*arguments, command); };
}

}  // namespace taut::app
