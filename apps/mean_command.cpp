// taut mean: the Karcher mean of points on a surface.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>

#include "geodesic_arguments.hpp"
#include "input_files.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/query/point_sets.hpp"
#include "terminal.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

struct MeanArguments {
  GeodesicArguments geodesic;
  std::string points;
  std::string weights;
  bool json = false;
};

ExitCode run(MeanArguments arguments) {
  const Context context = terminal_context(arguments.geodesic.common.terminal);
  const Surface surface = arguments.geodesic.load(context);
  const Points points = read_point_list(arguments.points, surface, context);
  const Vector weights = arguments.weights.empty() ? Vector() : parse_numbers(arguments.weights, "--weights");
  KarcherMeanOptions options;
  options.distance = arguments.geodesic.distance_options();
  const KarcherMean result = karcher_mean(surface, points, weights, options, context);
  clear_progress();
  if (arguments.json) {
    nlohmann::ordered_json json;
    json["command"] = "mean";
    json["status"] = to_string(result.status);
    if (!result.message.empty()) json["message"] = result.message;
    json["surface"] = {{"kind", surface.kind()}, {"dim", surface.dim()}, {"codim", surface.codim()}};
    json["point"] = vector_json(result.point);
    json["variance"] = result.variance;
    json["gradient"] = result.gradient;
    json["unique"] = result.unique;
    json["others"] = nlohmann::ordered_json::array();
    for (const Vector& other : result.others) json["others"].push_back(vector_json(other));
    json["iterations"] = result.num_iterations;
    std::cout << json.dump() << "\n";
  } else {
    std::string status(to_string(result.status));
    if (!result.message.empty()) status += ": " + result.message;
    std::vector<SceneFact> facts = {
        {"mean", vector_text(result.point)},
        {"deviation", fmt::format("{:.12g}: the root of the mean squared distance", std::sqrt(result.variance))},
        {"gradient", fmt::format("{:.1e} after {} steps", result.gradient, result.num_iterations)},
        {"unique", result.unique ? "no other was found" : "no"}};
    for (const Vector& other : result.others) facts.push_back({"another", vector_text(other)});
    facts.push_back({"status", status});
    std::cout << facts_text(facts);
  }
  if (result.status != Status::ok) print_error(fmt::format("{}: {}", to_string(result.status), result.message));
  return exit_code(result.status);
}

}  // namespace

Run add_mean_command(CLI::App& app) {
  auto arguments = std::make_shared<MeanArguments>();
  CLI::App& command = *app.add_subcommand("mean", "the point with the least mean squared distance from given ones");
  arguments->geodesic.add_to(command);
  command.add_option("--points", arguments->points, "points, one a line, - = stdin")->required();
  command.add_option("--weights", arguments->weights, "a weight for each: 1,1,2 (default: equal)");
  command.add_flag("--json", arguments->json, "the result as one JSON object on stdout");
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
