// taut matrix: distances between all pairs of many points, or the near ones of each.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>

#include "geodesic_arguments.hpp"
#include "input_files.hpp"
#include "matrix_file.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "surface_request.hpp"
#include "taut/core/error.hpp"
#include "taut/query/distance_matrix.hpp"
#include "terminal.hpp"
#include "timer.hpp"

namespace taut::app {
namespace {

struct MatrixArguments {
  GeodesicArguments geodesic;
  std::string points;
  std::string targets;
  std::string out;
  Index k_nearest = 0;
  double max_distance = std::numeric_limits<double>::infinity();
  bool condensed = false;
};

/// FNV-1a of the coordinates: tells whether a file still holds the same points.
std::uint64_t fingerprint(const PointsIn& points) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (Index j = 0; j < points.cols(); ++j) {
    for (Index i = 0; i < points.rows(); ++i) {
      std::uint64_t bits = 0;
      const double x = points(i, j);
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 0x100000001B3ULL;
    }
  }
  return hash;
}

std::string request_line(const MatrixArguments& arguments, const PointsIn& points, const PointsIn& targets) {
  const PathOptions& options = arguments.geodesic.options;
  std::string line =
      fmt::format("taut matrix {} {} {:016x} {} {:016x} {} {} {} {} {} {} {}",
                  surface_request(arguments.geodesic.surface), points.cols(), fingerprint(points), targets.cols(),
                  fingerprint(targets), arguments.k_nearest, arguments.max_distance, arguments.condensed,
                  options.tolerance, options.cell, static_cast<int>(options.grid), static_cast<int>(options.march));
  std::ranges::replace(line, '\n', ' ');
  return line;
}

ExitCode run(MatrixArguments arguments) {
  const bool sparse = arguments.k_nearest > 0 || std::isfinite(arguments.max_distance);
  const bool square = arguments.targets.empty();
  if (arguments.k_nearest > 0 && std::isfinite(arguments.max_distance)) {
    throw UsageError("give --k-nearest or --max-distance, not both");
  }
  if (arguments.condensed && (sparse || !square)) {
    throw UsageError("--condensed is for all pairs of one set of points");
  }
  if (!arguments.out.ends_with(".npy") && !arguments.out.ends_with(".csv")) {
    throw UsageError("--out " + arguments.out + ": a matrix goes to .npy or .csv");
  }
  refuse_to_overwrite({arguments.geodesic.surface.surface, arguments.points, arguments.targets}, {arguments.out});
  const Timer timer;
  const Context context = terminal_context(arguments.geodesic.common.terminal);
  const Surface surface = arguments.geodesic.load(context);
  const Points points = read_point_list(arguments.points, surface, context);
  const Points targets = square ? Points(surface.dim(), 0) : read_point_list(arguments.targets, surface, context);
  MatrixOptions options{.distance = arguments.geodesic.distance_options(), .k_nearest = arguments.k_nearest};
  options.distance.max_distance = arguments.max_distance;
  DistanceMatrix matrix = square ? DistanceMatrix(surface, points, options, context)
                                 : DistanceMatrix(surface, points, targets, options, context);
  const MatrixLayout layout = sparse                ? MatrixLayout::sparse
                              : arguments.condensed ? MatrixLayout::condensed
                              : square              ? MatrixLayout::square
                                                    : MatrixLayout::full;
  MatrixFile file(arguments.out, request_line(arguments, points, targets), layout, matrix.num_rows(),
                  matrix.num_columns());
  const bool resumed = file.num_done() > 0;
  if (resumed) {
    context.tell(fmt::format("going on after {} of {} rows, which an earlier run has answered", file.num_done(),
                             matrix.num_rows()));
  }
  constexpr Index kBlock = 32;  // rows; what a kill may lose
  double error = 0;
  while (file.num_done() < matrix.num_rows()) {
    const Index first = file.num_done();
    for (const MatrixRow& row : matrix.rows(first, std::min(kBlock, matrix.num_rows() - first))) {
      file.add(row.column, row.distance);
      for (std::size_t s = 0; s < row.error.size(); ++s) {
        if (std::isfinite(row.distance[s])) error = std::max(error, row.error[s]);
      }
    }
    file.flush();
    context.report("matrix", static_cast<double>(file.num_done()) / static_cast<double>(matrix.num_rows()));
  }
  file.finish();
  clear_progress();
  for (const std::string& message : matrix.messages()) print_error(message);
  std::vector<SceneFact> facts = {
      {"matrix", fmt::format("{} x {}, {} distances computed", grouped(matrix.num_rows()),
                             grouped(matrix.num_columns()), grouped(file.num_entries()))},
      {"error", fmt::format("{:.1e} at most, estimated{}", error, resumed ? ", of the rows of this run" : "")},
      {"time", fmt::format("{:.3g} s", timer.seconds())}};
  if (file.num_apart() > 0) facts.push_back({"apart", grouped(file.num_apart()) + " without a path: inf"});
  if (file.num_unknown() > 0) facts.push_back({"unknown", grouped(file.num_unknown()) + " not found out: nan"});
  std::cout << facts_text(facts);
  return file.num_unknown() > 0 ? kSomeLinesFailed : kDone;
}

}  // namespace

Run add_matrix_command(CLI::App& app) {
  auto arguments = std::make_shared<MatrixArguments>();
  CLI::App& command = *app.add_subcommand("matrix", "distances between all pairs of many points");
  arguments->geodesic.add_to(command);
  command.add_option("--points", arguments->points, "points, one a line, - = stdin")->required();
  command.add_option("--targets", arguments->targets, "from each point to each of these instead of all pairs");
  command.add_option("-o,--out", arguments->out, "the matrix: .npy or .csv; after a kill the same command goes on")
      ->required();
  command
      .add_option("--k-nearest", arguments->k_nearest, "only the so many nearest of each point: row,column,distance")
      ->check(whole_number(1, 1000000000));
  command.add_option("--max-distance", arguments->max_distance, "only pairs that near: row,column,distance")
      ->check(positive_number());
  command.add_flag("--condensed", arguments->condensed,
                   "the upper triangle as one row, as SciPy's squareform takes it");
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
