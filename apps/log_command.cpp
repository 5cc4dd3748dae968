// taut log: in which direction, and how far, the shortest geodesic to a point begins; or to many.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "batch_errors.hpp"
#include "formula_argument.hpp"
#include "geodesic_arguments.hpp"
#include "input_files.hpp"
#include "number_rows.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/tangent_maps.hpp"
#include "taut/surface/formula.hpp"
#include "terminal.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

struct LogArguments {
  GeodesicArguments geodesic;
  std::string from;
  std::string to;
  std::string to_file;
  std::vector<std::string> derivatives;
  bool json = false;
  bool header = false;
};

/// dL/dc for the parameters c of the formula that were asked for.
Vector parameter_derivatives(const LogArguments& arguments, const Surface& surface, const LogMapResult& result) {
  const SurfaceArguments& given = arguments.geodesic.surface;
  if (names_a_file(given.surface) || given.surface.starts_with('@')) {
    throw UsageError("--derivative is for the parameters (--set) of a formula that is typed");
  }
  FormulaOptions options = formula_options(given);
  Vector parameters(static_cast<Index>(arguments.derivatives.size()));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < arguments.derivatives.size(); ++i) {
    const std::string& name = arguments.derivatives[i];
    const auto place = options.parameters.find(name);
    if (place == options.parameters.end()) {
      throw UsageError(fmt::format("--derivative {}: no such parameter; give it a value by --set {}=1", name, name));
    }
    parameters(static_cast<Index>(i)) = place->second;
    options.parameters.erase(place);
    names.push_back(name);
  }
  const Index d = surface.dim();
  const auto parse = [&](std::vector<std::string> variables) {
    variables.insert(variables.end(), names.begin(), names.end());
    FormulaOptions extended = options;
    extended.variables = std::move(variables);
    extended.dim.reset();
    return length_derivative(*parse_function(given.surface, extended), result.curve, parameters);
  };
  if (!options.variables.empty()) return parse(options.variables);
  std::vector<std::string> numbered;
  for (Index i = 1; i <= d; ++i) numbered.push_back(fmt::format("x{}", i));
  if (d > 4) return parse(numbered);
  std::vector<std::string> letters = {"x", "y", "z", "w"};
  letters.resize(static_cast<std::size_t>(d));
  try {
    return parse(letters);
  } catch (const ParseError&) {
    return parse(numbered);
  }
}

nlohmann::ordered_json log_json(const Surface& surface, const LogMapResult& result) {
  nlohmann::ordered_json json;
  json["command"] = "log";
  json["status"] = to_string(result.status);
  if (!result.message.empty()) json["message"] = result.message;
  json["surface"] = {{"kind", surface.kind()}, {"dim", surface.dim()}, {"codim", surface.codim()}};
  json["from"] = vector_json(result.from);
  json["to"] = vector_json(result.to);
  json["direction"] = vector_json(result.direction);
  json["length"] = result.length;
  json["length_error"] = number_json(result.length_error);
  json["velocity"] = vector_json(result.velocity());
  json["arrival"] = vector_json(result.arrival);
  json["miss"] = number_json(result.miss);
  json["unique"] = unique_json(result.unique, result.tied);
  if (result.scales && result.scales->status == Status::ok) {
    const GeodesicScales& scales = *result.scales;
    json["m12"] = scales.m12;
    json["M12"] = scales.M12;
    json["M21"] = scales.M21;
    json["scales_error"] = scales.error;
  }
  return json;
}

std::vector<SceneFact> log_facts(const LogMapResult& result) {
  std::vector<SceneFact> facts;
  facts.push_back({"velocity", vector_text(result.velocity())});
  facts.push_back({"length", fmt::format("{:.15g} +- {:.1e}", result.length, result.length_error)});
  facts.push_back({"direction", vector_text(result.direction)});
  facts.push_back({"arrival", vector_text(result.arrival)});
  if (result.scales && result.scales->status == Status::ok) {
    const GeodesicScales& scales = *result.scales;
    facts.push_back({"scales", fmt::format("m12 {:.15g}, M12 {:.15g}, M21 {:.15g} +- {:.1e}", scales.m12, scales.M12,
                                           scales.M21, scales.error)});
  }
  facts.push_back({"check", fmt::format("the ray that begins so misses the point by {:.1e}", result.miss)});
  facts.push_back({"unique", result.unique ? "yes" : result.tied ? "no: another direction is as good" : "not known"});
  std::string status(to_string(result.status));
  if (!result.message.empty()) status += ": " + result.message;
  facts.push_back({"status", status});
  return facts;
}

ExitCode log_of_one(const LogArguments& arguments, const Surface& surface, const Context& context) {
  const LogMapResult result = log_map(surface, parse_point(arguments.from, "--from", surface),
                                      parse_point(arguments.to, "--to", surface), arguments.geodesic.options, context);
  clear_progress();
  nlohmann::ordered_json json = log_json(surface, result);
  std::vector<SceneFact> facts = log_facts(result);
  if (!arguments.derivatives.empty() && result.curve.num_elements() > 0) {
    const Vector derivatives = parameter_derivatives(arguments, surface, result);
    for (std::size_t i = 0; i < arguments.derivatives.size(); ++i) {
      const double value = derivatives(static_cast<Index>(i));
      json["derivatives"][arguments.derivatives[i]] = value;
      facts.insert(facts.end() - 1, {"d length", fmt::format("/ d {} = {:.15g}", arguments.derivatives[i], value)});
    }
  }
  if (arguments.json) {
    std::cout << json.dump() << "\n";
  } else if (result.direction.allFinite() || result.length == 0) {
    std::cout << facts_text(facts);
  }
  if (result.status != Status::ok) print_error(fmt::format("{}: {}", to_string(result.status), result.message));
  return exit_code(result.status);
}

/// A line a target: what `taut exp --rays` takes behind the start, and the error.
ExitCode log_of_many(const LogArguments& arguments, const Surface& surface, const Context& context) {
  const Index d = surface.dim();
  CsvRows rows = open_rows(arguments.to_file, surface);
  const NumberRows targets =
      read_number_rows(rows, d, std::numeric_limits<Index>::max(), fmt::format("a point takes {}", d));
  // Directions are some hundred times less exact than lengths.
  DistanceOptions options = arguments.geodesic.distance_options();
  options.tolerance = std::max(1e-13, options.tolerance / 100);
  DistanceSolver solver(surface, parse_point(arguments.from, "--from", surface), {}, options, context);
  const Distances found = solver.at(targets.values);
  clear_progress();
  BatchErrors errors(arguments.to_file == "-" ? "standard input" : arguments.to_file);
  std::string lines = arguments.header ? column_names("v", d) + "length,error,status\n" : "";
  for (Index j = 0; j < targets.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const bool ok = found.status[i] == Status::ok;
    const std::string& problem = targets.problems[i];
    if (!ok) errors.tell(targets.lines[i], problem.empty() ? found.message.at(j) : problem);
    const double length = ok ? found.distance(j) : std::numeric_limits<double>::quiet_NaN();
    // At the source itself every direction serves; which one is no answer, and none is wrong.
    lines += vector_columns(found.departure.col(j)) +
             fmt::format("{},{},{}\n", length, found.error(j),
                         problem.empty() ? to_string(found.status[i]) : std::string_view(kBadInputStatus));
  }
  std::cout << lines;
  return errors.any() ? kSomeLinesFailed : kDone;
}

ExitCode run(LogArguments arguments) {
  if (arguments.to.empty() == arguments.to_file.empty()) {
    throw UsageError("give --to or --to-file (see taut log --help)");
  }
  const bool many = !arguments.to_file.empty();
  if (!arguments.derivatives.empty() && many) throw UsageError("--derivative is for --to");
  if (arguments.json && many) throw UsageError("--to-file writes lines; --json is for --to");
  if (arguments.header && !many) throw UsageError("--header is for the lines of --to-file");
  const Context context = terminal_context(arguments.geodesic.common.terminal);
  const Surface surface = arguments.geodesic.load(context);
  return many ? log_of_many(arguments, surface, context) : log_of_one(arguments, surface, context);
}

}  // namespace

Run add_log_command(CLI::App& app) {
  auto arguments = std::make_shared<LogArguments>();
  CLI::App& command = *app.add_subcommand("log", "in which direction, and how far, a point lies from another");
  arguments->geodesic.add_to(command);
  command.add_option("--from", arguments->from, "start: 1,0,0, or @17 for the 17th sample from 0")->required();
  command.add_option("--to", arguments->to, "end, likewise");
  command.add_option("--to-file", arguments->to_file,
                     "ends, one a line, - = stdin; writes v1,...,vd,length,error,status, v the unit direction");
  command
      .add_option("--derivative", arguments->derivatives,
                  "--to: how the length changes with this parameter (--set) of the formula (repeatable)")
      ->allow_extra_args(false);
  command.add_flag("--json", arguments->json, "the result as one JSON object on stdout");
  command.add_flag("--header", arguments->header, "--to-file: a first line with the columns' names");
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
