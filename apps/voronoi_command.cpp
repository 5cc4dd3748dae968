// taut voronoi: which of several sources is the nearest, where, and where the parts meet.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>
#include <vector>

#include "batch_errors.hpp"
#include "geodesic_arguments.hpp"
#include "input_files.hpp"
#include "output.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/point_sets.hpp"
#include "terminal.hpp"

namespace taut::app {
namespace {

struct VoronoiArguments {
  GeodesicArguments geodesic;
  std::string sources;
  std::string at;
  std::string boundaries;
  double max_distance = std::numeric_limits<double>::infinity();
  FileArguments files;
};

/// "source,distance,error" for each point.
ExitCode label_points(const VoronoiArguments& arguments, const Surface& surface, const Points& sources,
                      const DistanceOptions& options, const Context& context) {
  const Points at = read_point_list(arguments.at, surface, context);
  DistanceSolver solver(surface, sources, {}, options, context);
  const Distances found = solver.at(at);
  clear_progress();
  BatchErrors errors(arguments.at == "-" ? "standard input" : arguments.at);
  std::string lines;
  for (Index j = 0; j < at.cols(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const bool ok = found.status[i] == Status::ok;
    if (!ok) errors.tell(i + 1, found.message.at(j), "point");
    const bool unknown = !ok && found.status[i] != Status::disconnected;
    lines += fmt::format("{},{},{}\n", found.source[i],
                         unknown ? std::numeric_limits<double>::quiet_NaN() : found.distance(j), found.error(j));
  }
  std::cout << lines;
  return errors.any() ? kSomeLinesFailed : kDone;
}

ExitCode run(VoronoiArguments arguments) {
  const bool drawn = !arguments.files.out.empty() || !arguments.boundaries.empty();
  if (arguments.at.empty() != drawn) {
    throw UsageError(
        "give --out FILE or --boundaries FILE for the whole surface, or --at POINTS.csv (see taut voronoi "
        "--help)");
  }
  arguments.files.check(OutputKind::mesh);
  std::vector<std::string> results = arguments.files.out;
  results.push_back(arguments.boundaries);
  refuse_to_overwrite({arguments.geodesic.surface.surface, arguments.sources, arguments.at}, results);
  const Context context = terminal_context(arguments.geodesic.common.terminal);
  const Surface surface = arguments.geodesic.load(context);
  const Points sources = read_point_list(arguments.sources, surface, context);
  DistanceOptions options = arguments.geodesic.distance_options();
  options.max_distance = arguments.max_distance;
  if (!arguments.at.empty()) return label_points(arguments, surface, sources, options, context);
  const VoronoiResult result = geodesic_voronoi(surface, sources, options, context);
  clear_progress();
  const std::vector<SceneFact> facts = {
      {"sources", grouped(sources.cols())},
      {"exact", fmt::format("{} of {} vertices, {} of {} points of the boundaries", grouped(result.num_exact),
                            grouped(result.mesh.vertices.cols()), grouped(result.num_exact_boundary),
                            grouped(result.boundaries.num_points()))},
      {"lines", grouped(static_cast<Index>(result.boundaries.lines.size()))}};
  MeshOutput output{.surface = surface,
                    .mesh = result.mesh,
                    .isolines = {},
                    .edges = result.mesh.edges,
                    .marks = sources,
                    .facts = facts,
                    .title = "Nearest sources on " + picture_title(arguments.geodesic.surface.surface)};
  FileArguments pictures = arguments.files;
  FileArguments others = arguments.files;
  const auto is_picture = [](const std::string& file) {
    return FileArguments{.out = {file}, .view = {}}.has_picture();
  };
  std::erase_if(pictures.out, [&](const std::string& file) { return !is_picture(file); });
  std::erase_if(others.out, is_picture);
  write_mesh_files(others, output);
  output.isolines = result.boundaries;
  write_mesh_files(pictures, output);
  if (!arguments.boundaries.empty()) write_polylines(arguments.boundaries, result.boundaries);
  std::cout << facts_text(facts);
  return kDone;
}

}  // namespace

Run add_voronoi_command(CLI::App& app) {
  auto arguments = std::make_shared<VoronoiArguments>();
  CLI::App& command = *app.add_subcommand("voronoi", "which of several sources is the nearest, everywhere");
  arguments->geodesic.add_to(command);
  command.add_option("--sources", arguments->sources, "points, one a line, - = stdin")->required();
  command.add_option("--at", arguments->at, "points, one a line: writes source,distance,error for each");
  command.add_option("--boundaries", arguments->boundaries,
                     "the lines between the parts to FILE, by extension: .csv .ply .vtp ...");
  command.add_option("--max-distance", arguments->max_distance, "leave out what is farther from every source")
      ->check(positive_number());
  arguments->files.add_to(command, OutputKind::mesh, "the surface with each vertex's nearest source");
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
