// taut path: one pair, perhaps through points on the way, one source to many destinations, many pairs, or in the
// class of a polyline.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "batch_errors.hpp"
#include "cell_arguments.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "deliver_path.hpp"
#include "help_format.hpp"
#include "input_files.hpp"
#include "load_surface.hpp"
#include "output.hpp"
#include "path_class.hpp"
#include "path_lines.hpp"
#include "path_pairs.hpp"
#include "path_sources.hpp"
#include "path_via.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "surface_request.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/query/path.hpp"
#include "timer.hpp"

namespace taut::app {
namespace {

struct PathArguments {
  CommonArguments common;
  SurfaceArguments surface;
  std::vector<std::string> from;
  std::string to;
  std::vector<std::string> via;
  std::string to_file;
  std::string pairs;
  std::string start;
  std::string closed;
  PathOptions options;
  DeliveryArguments delivery;
  PathShow show;
  bool verify = false;
  std::vector<const CLI::Option*> of_the_flow;  // without effect on other methods
  BatchColumns columns;
  bool header = false;
  Index samples_along = 0;
};

/// Follows the path from its start as a ray and reports where it lands.
void add_verification(const Surface& surface, const PathResult& result, const Context& context,
                      nlohmann::ordered_json& json, std::vector<SceneFact>& facts) {
  json["verify"] = nullptr;
  if (result.start_direction.size() == 0) {
    facts.push_back({"verify", "no direction to start in"});
    return;
  }
  const Verification found =
      verify_geodesic(surface, result.from, result.start_direction, result.length, result.to, context);
  const auto number = [](double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nullptr; };
  json["verify"] = {{"status", to_string(found.status)},
                    {"miss", number(found.miss)},
                    {"miss_along", number(found.miss_along)},
                    {"error", number(found.error)},
                    {"amplification", number(found.amplification)}};
  facts.push_back(
      {"verify", fmt::format("followed as a ray it misses the end by {:.1e}, {:.1e} of it along; rays spread "
                             "by {:.3g} ({})",
                             found.miss, std::abs(found.miss_along), found.amplification, to_string(found.status))});
}

/// The JSON of a path, its points as --samples-along wants them.
nlohmann::ordered_json json_of(const PathArguments& arguments, const Surface& surface, const PathResult& result,
                               double surface_seconds, double total_seconds) {
  auto json = path_json(surface, result, arguments.options, surface_seconds, total_seconds);
  space_points(surface, result, arguments.samples_along, json);
  return json;
}

PathOutput output_of(const PathArguments& arguments, const Surface& surface, const PathResult& result,
                     const nlohmann::ordered_json& json, const std::vector<SceneFact>& facts) {
  return {.surface = surface,
          .sources = {{arguments.options.method == CorrectionMethod::grid ? "marched path" : "geodesic", {&result}}},
          .json = json,
          .facts = facts,
          .title = picture_title(arguments.surface.surface),
          .show = arguments.show,
          .field = field_options(arguments.options),
          .all_ways = arguments.options.all,
          .evenly_spaced = arguments.samples_along};
}

ExitCode run_one(const PathArguments& arguments, const Surface& surface, const Context& context, double surface_seconds,
                 const Timer& timer) {
  PathSolver solver(surface, arguments.options, context);
  const Vector p = parse_point(arguments.from.front(), "--from", surface);
  const Vector q = parse_point(arguments.to, "--to", surface);
  const PathResult result = solver.solve(p, q);
  clear_progress();
  const double total = timer.seconds();
  auto json = json_of(arguments, surface, result, surface_seconds, total);
  std::vector<SceneFact> facts = path_facts(surface, result, arguments.options, surface_seconds, total);
  if (arguments.verify) add_verification(surface, result, context, json, facts);
  return deliver_path(arguments.delivery, output_of(arguments, surface, result, json, facts), context);
}

/// Through points on the way.
ExitCode run_via(const PathArguments& arguments, const Surface& surface, const Context& context, double surface_seconds,
                 const Timer& timer) {
  PathSolver solver(surface, arguments.options, context);
  Points points(surface.dim(), static_cast<Index>(arguments.via.size()) + 2);
  points.col(0) = parse_point(arguments.from.front(), "--from", surface);
  for (std::size_t i = 0; i < arguments.via.size(); ++i) {
    points.col(static_cast<Index>(i) + 1) = parse_point(arguments.via[i], "--via", surface);
  }
  points.rightCols(1) = parse_point(arguments.to, "--to", surface);
  const ViaResult result = path_through(solver, points);
  clear_progress();
  const double total = timer.seconds();
  auto json = json_of(arguments, surface, result, surface_seconds, total);
  std::vector<SceneFact> facts = path_facts(surface, result, arguments.options, surface_seconds, total);
  add_legs(result, json);
  add_legs(result, facts);
  PathOutput output = output_of(arguments, surface, result, json, facts);
  for (std::size_t i = 1; i < result.legs.size(); ++i) {
    output.marks.push_back({.position = result.legs[i].from, .label = "via"});
  }
  return deliver_path(arguments.delivery, output, context);
}

/// In the class of a polyline, or of a loop.
ExitCode run_in_class(const PathArguments& arguments, const Surface& surface, const Context& context,
                      double surface_seconds, const Timer& timer) {
  nlohmann::ordered_json json;
  std::vector<SceneFact> facts;
  const auto deliver = [&](const PathResult& result) {
    if (arguments.verify) add_verification(surface, result, context, json, facts);
    return deliver_path(arguments.delivery, output_of(arguments, surface, result, json, facts), context);
  };
  const auto describe = [&](const PathResult& result) {
    clear_progress();
    const double total = timer.seconds();
    json = json_of(arguments, surface, result, surface_seconds, total);
    json["unique"] = nullptr;
    facts = path_facts(surface, result, arguments.options, surface_seconds, total);
  };
  if (!arguments.closed.empty()) {
    const ClosedGeodesic loop = close_polyline(arguments.closed, surface, arguments.options, context);
    describe(loop);
    add_closed(loop, json);
    add_closed(loop, facts);
    return deliver(loop);
  }
  const PolylineRequest request{
      .file = arguments.start, .from = arguments.from.empty() ? "" : arguments.from.front(), .to = arguments.to};
  const PathResult path = shorten_polyline(request, surface, arguments.options, context);
  describe(path);
  return deliver(path);
}

ExitCode run_pairs(const PathArguments& arguments, const Surface& surface, const Context& context) {
  PairsRequest request{.file = arguments.pairs,
                       .out = {},
                       .surface = surface_request(arguments.surface),
                       .options = arguments.options,
                       .columns = arguments.columns,
                       .header = arguments.header};
  const std::vector<std::string>& out = arguments.delivery.files.out;
  if (!out.empty()) request.out = out.front();
  return answer_pairs(request, surface, context);
}

void check_class_usage(const PathArguments& arguments) {
  const char* option = arguments.closed.empty() ? "--start" : "--closed";
  if (!arguments.start.empty() && !arguments.closed.empty()) throw UsageError("give --start or --closed, not both");
  if (!arguments.via.empty() || !arguments.to_file.empty() || !arguments.pairs.empty() || arguments.options.all) {
    throw UsageError(fmt::format("{} goes without --via, --to-file, --pairs and --all", option));
  }
  if (!arguments.closed.empty() && (!arguments.from.empty() || !arguments.to.empty())) {
    throw UsageError("--closed has no ends: leave --from and --to out");
  }
  if (arguments.options.method == CorrectionMethod::grid ||
      (!arguments.closed.empty() && arguments.options.method != CorrectionMethod::newton)) {
    throw UsageError(fmt::format("{} goes with --method newton{}", option, arguments.closed.empty() ? " or flow" : ""));
  }
}

/// Options that what was asked for never looks at.
void check_effects(const PathArguments& arguments, const CLI::App& command) {
  const PathOptions& options = arguments.options;
  check_envelope_usage(options.march, options.envelope);
  if (!arguments.start.empty() || !arguments.closed.empty()) {
    refuse_without_effect(command, {"--march", "--envelope", "--grid", "--samples", "--show"},
                          "a polyline is shortened as it is, without a march");
  }
  if (options.method == CorrectionMethod::grid) {
    refuse_without_effect(command, {"--tol"}, "--method grid corrects nothing");
  }
  if (options.all && (options.march != MarchMethod::convergent || options.method == CorrectionMethod::grid)) {
    throw UsageError(
        "--all has no effect: only --march convergent tells ways round apart, and --method grid takes one");
  }
}

ExitCode run(PathArguments arguments, const CLI::App& command) {
  const bool one = !arguments.from.empty() && !arguments.to.empty();
  const bool many = !arguments.from.empty() && !arguments.to_file.empty();
  const bool pairs = !arguments.pairs.empty();
  const bool in_class = !arguments.start.empty() || !arguments.closed.empty();
  if (in_class) check_class_usage(arguments);
  for (const CLI::Option* option : arguments.of_the_flow) {
    if (option->count() > 0 && arguments.options.method != CorrectionMethod::flow) {
      throw UsageError(fmt::format("{} is for --method flow", option->get_name()));
    }
  }
  if (!in_class &&
      (int{one} + int{many} + int{pairs} != 1 || (pairs && !(arguments.from.empty() && arguments.to.empty())))) {
    throw UsageError(
        "give --from with --to, or --from with --to-file, or --pairs, --start or --closed (see taut path --help)");
  }
  if (arguments.from.size() > 1 && !many) throw UsageError("several --from go with --to-file");
  const bool via = !arguments.via.empty();
  if (via && !one) throw UsageError("--via stands between --from and --to");
  if (via && (arguments.options.all || arguments.verify)) {
    throw UsageError("--all and --verify are for a path without --via: ask for the legs one by one");
  }
  if (arguments.verify && ((!one && !in_class) || arguments.options.method != CorrectionMethod::newton)) {
    throw UsageError("--verify is for one path found by --method newton");
  }
  check_effects(arguments, command);
  arguments.delivery.files.check(OutputKind::path);
  arguments.show.check(arguments.delivery.files);
  arguments.options.keep_cells = arguments.show.cells;
  const std::vector<std::string>& out = arguments.delivery.files.out;
  if (pairs && (out.size() > 1 || (out.size() == 1 && !out.front().ends_with(".csv")))) {
    throw UsageError("--pairs writes lines: give one --out FILE.csv, or none for stdout");
  }
  if (pairs && arguments.samples_along > 0)
    throw UsageError("--samples-along is for the points of paths; --pairs has none");
  if ((arguments.header || arguments.columns.unique) && ((!pairs && !many) || arguments.delivery.json)) {
    throw UsageError("--header and --unique are for the lines of --pairs and --to-file");
  }
  refuse_to_overwrite({arguments.pairs, arguments.to_file, arguments.start, arguments.closed, arguments.surface.samples,
                       arguments.surface.surface},
                      out);
  if (pairs && arguments.delivery.json)
    throw UsageError("--pairs writes lines; --json is for --from with --to or --to-file");
  const Timer timer;
  const Context context = terminal_context(arguments.common.terminal);
  const Surface surface = load_surface(arguments.surface, context);
  const double surface_seconds = timer.seconds();
  if (!in_class) {
    arguments.options.seeds = read_seeds(arguments.surface, surface, arguments.options.grid, context);
  }
  if (in_class) return run_in_class(arguments, surface, context, surface_seconds, timer);
  if (via) return run_via(arguments, surface, context, surface_seconds, timer);
  if (one) return run_one(arguments, surface, context, surface_seconds, timer);
  if (many) {
    return answer_sources({.from = arguments.from,
                           .to_file = arguments.to_file,
                           .options = arguments.options,
                           .surface = arguments.surface.surface,
                           .show = arguments.show,
                           .columns = arguments.columns,
                           .header = arguments.header,
                           .samples_along = arguments.samples_along,
                           .surface_seconds = surface_seconds},
                          arguments.delivery, surface, context, timer);
  }
  return run_pairs(arguments, surface, context);
}

}  // namespace

Run add_path_command(CLI::App& app) {
  auto arguments = std::make_shared<PathArguments>();
  CLI::App& command = *app.add_subcommand("path", "shortest path between two points");
  arguments->surface.add_to(command);
  command
      .add_option("--from", arguments->from,
                  "start: 1,0,0, or @17 for the 17th sample from 0 (repeatable with --to-file)")
      ->allow_extra_args(false);
  command.add_option("--to", arguments->to, "end, likewise");
  command.add_option("--via", arguments->via, "a point to pass on the way (repeatable, in order), likewise")
      ->allow_extra_args(false);
  command.add_option("--to-file", arguments->to_file,
                     "ends, one a line, - = stdin: every path shares the start's marched field");
  command.add_option(
      "--pairs", arguments->pairs,
      "pairs p1,...,pd,q1,...,qd, one a line, - = stdin; writes length,error,converged,locally_shortest,status");
  command.add_option("--start", arguments->start,
                     "a polyline, one point a line: the geodesic it is pulled taut to, in its homotopy class");
  command.add_option("--closed", arguments->closed,
                     "a loop, one point a line: the closed geodesic in its class, or the point it shrinks to");
  PathOptions& options = arguments->options;
  command.add_option("--tol", options.tolerance, "relative length tolerance")
      ->check(number_between(1e-13, 1e-3))
      ->capture_default_str();
  add_cell_options(command, options.cell, options.grid);
  add_march_option(command, options.march);
  add_envelope_option(command, options.envelope);
  command
      .add_option("--method", options.method,
                  "newton: machine precision; flow: the paper's curvature flow; grid: the marched path as it is")
      ->transform(one_of<CorrectionMethod>(
          {{"newton", CorrectionMethod::newton}, {"flow", CorrectionMethod::flow}, {"grid", CorrectionMethod::grid}}));
  {
    const OptionGroup group(command, "The flow (--method flow)");
    arguments->of_the_flow = {
        command.add_option("--spacing", options.spacing, "longest interval between nodes (eps_E)")
            ->check(positive_number()),
        command.add_option("--beta", options.beta, "balance parameter of equation (4)")->check(positive_number()),
        command
            .add_option("--step", options.flow_step,
                        "time steps of equation (4), implicit, or explicit as in the paper")
            ->transform(one_of<FlowTimeStep>(
                {{"implicit", FlowTimeStep::linearly_implicit}, {"explicit", FlowTimeStep::explicit_euler}})),
        command.add_option("--nodes", options.flow_nodes, "nodes spread evenly, or by the radius of curvature")
            ->transform(one_of<NodeSpread>({{"even", NodeSpread::even}, {"curvature", NodeSpread::curvature}}))};
  }
  command.add_flag("--all", options.all, "look for every way round, and report each of them");
  command.add_flag("--verify", arguments->verify,
                   "follow the path as an initial-value problem, and say where it lands");
  command
      .add_option("--samples-along", arguments->samples_along,
                  "write so many points a path, evenly spaced by arc length (default: the path's own)")
      ->check(whole_number(2, 10000000));
  command.add_flag("--header", arguments->header, "--pairs, --to-file: a first line with the columns' names");
  command.add_flag("--unique", arguments->columns.unique,
                   "--pairs, --to-file: one more column, 1 where no other way is as short, else 0; empty: not known");
  arguments->delivery.add_to(command);
  arguments->show.add_to(command);
  arguments->common.add_to(command);
  return [arguments, &command] { return run(*arguments, command); };
}

}  // namespace taut::app
