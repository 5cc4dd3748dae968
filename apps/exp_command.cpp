// taut exp: a geodesic from a point in a direction, or many of them.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

#include "batch_errors.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "deliver_path.hpp"
#include "input_files.hpp"
#include "load_surface.hpp"
#include "number_rows.hpp"
#include "output.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_points.hpp"
#include "taut/query/tangent_maps.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

using Json = nlohmann::ordered_json;

struct ExpArguments {
  CommonArguments common;
  SurfaceArguments surface;
  std::string from;
  std::string direction;
  std::optional<double> length;
  std::string rays;
  ExponentialOptions options;
  bool no_conjugate = false;
  bool header = false;
  DeliveryArguments delivery;
};

Json ray_json(const Surface& surface, const RayResult& result, double asked, double seconds) {
  Json json;
  json["command"] = "exp";
  json["status"] = to_string(result.status);
  if (!result.message.empty()) json["message"] = result.message;
  json["surface"] = {{"kind", surface.kind()}, {"dim", surface.dim()}, {"codim", surface.codim()}};
  json["from"] = vector_json(result.from);
  json["point"] = vector_json(result.point);
  json["direction"] = vector_json(result.direction);
  json["length"] = result.length;
  json["length_asked"] = asked;
  json["converged"] = result.status == Status::ok;
  json["error"] = number_json(result.error);
  json["direction_error"] = number_json(result.direction_error);
  json["amplification"] = number_json(result.amplification);
  json["conjugate_at"] = result.conjugate_at ? Json(*result.conjugate_at) : Json(nullptr);
  json["conjugate_searched"] = result.conjugate_searched;
  json["index"] = result.conjugate_searched != 0 ? Json(result.index) : Json(nullptr);
  if (!result.pieces.empty()) json["pieces"] = pieces_json(result.pieces);
  json["steps"] = result.num_steps;
  json["seconds"] = seconds;
  json["points"] = Json::array();
  for (Index j = 0; j < result.points.cols(); ++j) json["points"].push_back(vector_json(result.points.col(j)));
  return json;
}

std::vector<SceneFact> ray_facts(const RayResult& result) {
  std::vector<SceneFact> facts;
  facts.push_back({"point", fmt::format("{} +- {:.1e}", vector_text(result.point), result.error)});
  facts.push_back({"direction", fmt::format("{} +- {:.1e}", vector_text(result.direction), result.direction_error)});
  facts.push_back({"length", fmt::format("{:.15g}", result.length)});
  std::string status(to_string(result.status));
  if (!result.message.empty()) status += ": " + result.message;
  facts.push_back({"status", status});
  if (result.conjugate_at) {
    facts.push_back({"conjugate", fmt::format("first at {:.15g}, index {}", *result.conjugate_at, result.index)});
  } else {
    facts.push_back({"conjugate", result.conjugate_searched != 0 || result.length == 0 ? "none" : "not looked for"});
  }
  if (result.pieces.size() > 1) {
    facts.push_back(
        {"edges", fmt::format("{} crossed, over {} faces", result.pieces.size() / 2, result.pieces.size() / 2 + 1)});
  }
  facts.push_back({"spread", fmt::format("an error at the start grows by up to {:.3g}", result.amplification)});
  return facts;
}

ExitCode run_one(const ExpArguments& arguments, const Surface& surface, const Context& context) {
  RaySolver solver(surface, arguments.options, context);
  const Vector from = parse_point(arguments.from, "--from", surface);
  const Vector direction = parse_numbers(arguments.direction, "--dir");
  const auto begin = std::chrono::steady_clock::now();
  const RayResult result = solver.solve(from, direction, *arguments.length);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  clear_progress();
  PathResult drawn;
  drawn.status = result.status;
  drawn.message = result.message;
  drawn.from = result.from;
  drawn.to = result.point;
  drawn.length = std::abs(result.length);
  drawn.points = result.points;
  return deliver_path(arguments.delivery,
                      {.surface = surface,
                       .sources = {{"geodesic", {&drawn}}},
                       .json = ray_json(surface, result, *arguments.length, seconds),
                       .facts = ray_facts(result),
                       .title = picture_title(arguments.surface.surface),
                       .end_name = "end"},
                      context);
}

std::string ray_csv_header(Index d) {
  std::string line;
  for (const char* name : {"q", "w"}) {
    for (Index i = 1; i <= d; ++i) line += fmt::format("{}{},", name, i);
  }
  return line + "error,status";
}

/// A ray as a line; one that stopped early, or never began, has no end point.
std::string ray_csv(const RayResult& result, Index d, double asked, const std::string& problem) {
  std::string line;
  const bool arrived = result.point.size() == d && result.length == asked;
  for (const Vector* vector : {&result.point, &result.direction}) {
    for (Index i = 0; i < d; ++i) line += arrived ? fmt::format("{},", (*vector)(i)) : "nan,";
  }
  if (arrived) {
    line += fmt::format("{},{}", std::max(result.error, result.direction_error), to_string(result.status));
  } else {
    line += fmt::format("inf,{}", problem.empty() ? to_string(result.status) : kBadInputStatus);
  }
  return line;
}

/// Line k in, line k out, a bounded number of them at a time; a failed line carries its reason and the rest goes on.
ExitCode run_rays(const ExpArguments& arguments, const Surface& surface, const Context& context) {
  constexpr Index kAtOnce = 4096;
  const Index d = surface.dim();
  CsvRows rows = open_rows(arguments.rays, surface);
  BatchErrors errors(arguments.rays == "-" ? "standard input" : arguments.rays);
  ExponentialOptions options = arguments.options;
  options.conjugate = false;
  options.points = false;
  RaySolver solver(surface, options, context);
  if (arguments.header) std::cout << ray_csv_header(d) << "\n";
  Index count = 0;
  const std::string takes = fmt::format("a ray takes {}, p1,...,pd,v1,...,vd,s", 2 * d + 1);
  for (;;) {
    const NumberRows block = read_number_rows(rows, 2 * d + 1, kAtOnce, takes);
    if (block.size() == 0) break;
    const Points from = block.values.topRows(d);
    const Points directions = block.values.middleRows(d, d);
    const Vector lengths = block.values.row(2 * d).transpose();
    const std::vector<RayResult> results = solver.solve_many(from, directions, lengths);
    for (std::size_t j = 0; j < results.size(); ++j) {
      const RayResult& result = results[j];
      const std::string& problem = block.problems[j];
      if (result.status != Status::ok) errors.tell(block.lines[j], problem.empty() ? result.message : problem);
      std::cout << ray_csv(result, d, lengths(static_cast<Index>(j)), problem) << "\n";
    }
    context.report("rays", -static_cast<double>(count += block.size()));
  }
  return errors.any() ? kSomeLinesFailed : kDone;
}

ExitCode run(ExpArguments arguments) {
  const bool one = !arguments.from.empty() && !arguments.direction.empty() && arguments.length;
  const bool rays = !arguments.rays.empty();
  const bool any = !arguments.from.empty() || !arguments.direction.empty() || arguments.length;
  if (one == rays || (rays && any)) {
    throw UsageError("give --from, --dir and --length, or --rays (see taut exp --help)");
  }
  if (rays && (arguments.delivery.json || !arguments.delivery.files.out.empty())) {
    throw UsageError("--rays writes its lines to stdout; --json and --out are for one ray");
  }
  if (arguments.header && !rays) throw UsageError("--header is for the lines of --rays");
  if (!arguments.surface.box.empty()) {
    throw UsageError(
        "--box has no effect on a ray, which is followed without looking around; cut the surface by --domain");
  }
  arguments.delivery.files.check(OutputKind::path);
  refuse_to_overwrite({arguments.surface.surface}, arguments.delivery.files.out);
  arguments.options.conjugate = !arguments.no_conjugate;
  const Context context = terminal_context(arguments.common.terminal);
  const Surface surface = load_surface(arguments.surface, context);
  return one ? run_one(arguments, surface, context) : run_rays(arguments, surface, context);
}

}  // namespace

Run add_exp_command(CLI::App& app) {
  auto arguments = std::make_shared<ExpArguments>();
  CLI::App& command = *app.add_subcommand("exp", "geodesic from a point in a direction");
  arguments->surface.add_to(command);
  command.add_option("--from", arguments->from, "start: 1,0,0, or @17 for the 17th sample from 0");
  command.add_option("--dir", arguments->direction, "direction: 0,1,0; its part tangent to the surface counts");
  command.add_option("--length", arguments->length, "how far to go; negative: the other way")->check(any_number());
  command.add_option("--rays", arguments->rays,
                     "rays p1,...,pd,v1,...,vd,s, one a line, - = stdin; writes q1,...,qd,w1,...,wd,error,status");
  command
      .add_option("--tol", arguments->options.tolerance, "error a step may add (default: rounding; 1e-9 on dense fits)")
      ->check(number_between(0, 1e-3));
  command.add_option("--steps", arguments->options.max_steps, "give up after this many steps")
      ->check(whole_number(1, 1000000000))
      ->capture_default_str();
  command.add_flag("--no-conjugate", arguments->no_conjugate,
                   "do not look for conjugate points: faster in many dimensions");
  command.add_flag("--header", arguments->header, "--rays: a first line with the columns' names");
  arguments->delivery.add_to(command);
  arguments->common.add_to(command);
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
