// taut transport: vectors carried parallel along shortest paths, or along a curve.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>

#include "batch_errors.hpp"
#include "geodesic_arguments.hpp"
#include "input_files.hpp"
#include "number_rows.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_points.hpp"
#include "taut/query/tangent_maps.hpp"
#include "terminal.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

struct TransportArguments {
  GeodesicArguments geodesic;
  std::string from;
  std::string to;
  std::string to_file;
  std::string along;
  std::vector<std::string> vectors;
  bool json = false;
  bool header = false;
};

nlohmann::ordered_json vectors_json(const PointsIn& vectors) {
  auto json = nlohmann::ordered_json::array();
  for (Index j = 0; j < vectors.cols(); ++j) json.push_back(vector_json(vectors.col(j)));
  return json;
}

Points parse_vectors(const std::vector<std::string>& texts, Index d) {
  Points vectors(d, static_cast<Index>(texts.size()));
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const Vector v = parse_numbers(texts[i], "--vector");
    if (v.size() != d) {
      throw InvalidArgument(
          fmt::format("--vector {}: has {} components, the surface lies in {} dimensions", texts[i], v.size(), d));
    }
    vectors.col(static_cast<Index>(i)) = v;
  }
  return vectors;
}

/// Along one shortest path, or through the points of a curve.
ExitCode carry_one(const TransportArguments& arguments, const Surface& surface, const Context& context) {
  Points stations(surface.dim(), 2);
  if (!arguments.along.empty()) {
    stations = read_point_list(arguments.along, surface, context);
  } else {
    stations.col(0) = parse_point(arguments.from, "--from", surface);
    stations.col(1) = parse_point(arguments.to, "--to", surface);
  }
  if (stations.cols() < 2) throw InvalidArgument(arguments.along + ": a curve takes two points or more");
  PathSolver solver(surface, arguments.geodesic.options, context);
  const TransportResult result =
      transport_along(solver, stations, parse_vectors(arguments.vectors, surface.dim()), context);
  clear_progress();
  if (arguments.json) {
    nlohmann::ordered_json json;
    json["command"] = "transport";
    json["status"] = to_string(result.status);
    if (!result.message.empty()) json["message"] = result.message;
    json["surface"] = {{"kind", surface.kind()}, {"dim", surface.dim()}, {"codim", surface.codim()}};
    json["from"] = vector_json(result.from);
    json["to"] = vector_json(result.to);
    json["length"] = result.length;
    json["vectors_from"] = vectors_json(result.start);
    json["vectors"] = vectors_json(result.end);
    json["error"] = result.error;
    json["unique"] = unique_json(result.unique, result.tied);
    std::cout << json.dump() << "\n";
  } else if (result.status == Status::ok) {
    std::vector<SceneFact> facts;
    for (Index j = 0; j < result.end.cols(); ++j) facts.push_back({"vector", vector_text(result.end.col(j))});
    facts.push_back({"at", vector_text(result.to)});
    facts.push_back({"length", fmt::format("{:.15g}", result.length)});
    facts.push_back({"error", fmt::format("{:.1e} radians", result.error)});
    facts.push_back({"status", result.message.empty() ? "ok" : "ok: " + result.message});
    std::cout << facts_text(facts);
  }
  if (result.status != Status::ok) print_error(fmt::format("{}: {}", to_string(result.status), result.message));
  return exit_code(result.status);
}

std::string carried_line(const PointsIn& vectors, std::string_view status) {
  std::string line;
  for (Index c = 0; c < vectors.cols(); ++c) line += vector_columns(vectors.col(c));
  return line + std::string(status) + "\n";
}

/// To every target of a file: by the directions of a field on surfaces in space, else path by path.
ExitCode carry_to_many(const TransportArguments& arguments, const Surface& surface, const Context& context) {
  const Index d = surface.dim();
  CsvRows rows = open_rows(arguments.to_file, surface);
  const NumberRows targets =
      read_number_rows(rows, d, std::numeric_limits<Index>::max(), fmt::format("a point takes {}", d));
  const Points vectors = parse_vectors(arguments.vectors, d);
  const Index m = vectors.cols();
  const Vector from = parse_point(arguments.from, "--from", surface);
  BatchErrors errors(arguments.to_file == "-" ? "standard input" : arguments.to_file);
  std::string lines;
  if (arguments.header) {
    for (Index c = 1; c <= m; ++c) lines += column_names(m > 1 ? fmt::format("w{}_", c) : "w", d);
    lines += "status\n";
  }
  const Points nothing = Points::Constant(d, m, std::numeric_limits<double>::quiet_NaN());
  const auto answer = [&](Index j, const PointsIn& carried, Status status, const std::string& message) {
    const auto i = static_cast<std::size_t>(j);
    const std::string& problem = targets.problems[i];
    if (status != Status::ok || !problem.empty()) errors.tell(targets.lines[i], problem.empty() ? message : problem);
    lines += carried_line(carried, problem.empty() ? to_string(status) : std::string_view(kBadInputStatus));
  };
  if (d == 3 && surface.codim() == 1) {
    DistanceOptions options = arguments.geodesic.distance_options();
    options.tolerance = std::max(1e-13, options.tolerance / 100);  // directions are so much less exact than lengths
    DistanceSolver solver(surface, from, {}, options, context);
    const Distances found = solver.at(targets.values);
    const Points carried = transport_to_targets(surface, solver.sources().col(0), targets.values, found, vectors);
    for (Index j = 0; j < targets.size(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      const bool ok = found.status[i] == Status::ok;
      answer(j, ok ? Points(carried.middleCols(j * m, m)) : nothing, found.status[i], ok ? "" : found.message.at(j));
    }
  } else {
    PathSolver solver(surface, arguments.geodesic.options, context);
    for (Index j = 0; j < targets.size(); ++j) {
      if (!targets.problems[static_cast<std::size_t>(j)].empty()) {
        answer(j, nothing, Status::not_converged, "");
        continue;
      }
      Points stations(d, 2);
      stations << from, targets.values.col(j);
      try {
        const TransportResult one = transport_along(solver, stations, vectors, context);
        answer(j, one.end, one.status, one.message);
      } catch (const InvalidArgument& error) {
        answer(j, nothing, Status::not_converged, error.what());
      }
    }
  }
  clear_progress();
  std::cout << lines;
  return errors.any() ? kSomeLinesFailed : kDone;
}

ExitCode run(TransportArguments arguments) {
  const bool many = !arguments.to_file.empty();
  const bool along = !arguments.along.empty();
  const bool one = !arguments.to.empty();
  if (int{many} + int{along} + int{one} != 1 || along != arguments.from.empty()) {
    throw UsageError("give --from with --to or --to-file, or --along (see taut transport --help)");
  }
  if (arguments.json && many) throw UsageError("--to-file writes lines; --json is for --to and --along");
  if (arguments.header && !many) throw UsageError("--header is for the lines of --to-file");
  const Context context = terminal_context(arguments.geodesic.common.terminal);
  const Surface surface = arguments.geodesic.load(context);
  return many ? carry_to_many(arguments, surface, context) : carry_one(arguments, surface, context);
}

}  // namespace

Run add_transport_command(CLI::App& app) {
  auto arguments = std::make_shared<TransportArguments>();
  CLI::App& command = *app.add_subcommand("transport", "vectors carried parallel along a shortest path or a curve");
  arguments->geodesic.add_to(command);
  command
      .add_option("--vector", arguments->vectors,
                  "a vector at the start: 0,1,0; its part tangent to the surface counts (repeatable)")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--from", arguments->from, "start: 1,0,0, or @17 for the 17th sample from 0");
  command.add_option("--to", arguments->to, "end, likewise: along the shortest path");
  command.add_option("--to-file", arguments->to_file,
                     "ends, one a line, - = stdin; writes w1,...,wd for each vector, and the status");
  command.add_option(
      "--along", arguments->along,
      "a curve on the surface, a point a line, - = stdin: along the shortest paths from each to the next");
  command.add_flag("--json", arguments->json, "the result as one JSON object on stdout");
  command.add_flag("--header", arguments->header, "--to-file: a first line with the columns' names");
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
