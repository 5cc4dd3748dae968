#include "path_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <limits>

#include "batch_errors.hpp"
#include "ignored_faces.hpp"
#include "input_files.hpp"
#include "number_rows.hpp"
#include "path_lines.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/io/read_points.hpp"
#include "terminal.hpp"

namespace taut::app {

ExitCode answer_sources(const SourcesRequest& request, const DeliveryArguments& delivery, const Surface& surface,
                        const Context& context, const Timer& timer) {
  const auto num_sources = static_cast<Index>(request.from.size());
  Points sources(surface.dim(), num_sources);
  for (Index s = 0; s < num_sources; ++s) {
    sources.col(s) = parse_point(request.from[static_cast<std::size_t>(s)], "--from", surface);
  }
  CsvRows rows = open_rows(request.to_file, surface);
  const NumberRows targets = read_number_rows(rows, surface.dim(), std::numeric_limits<Index>::max(),
                                              fmt::format("a point takes {}", surface.dim()));
  PathSolver solver(surface, request.options, context);
  std::vector<std::vector<PathResult>> results;
  for (Index s = 0; s < num_sources; ++s) results.push_back(solver.solve_from(sources.col(s), targets.values));
  clear_progress();
  const double total = timer.seconds();

  BatchErrors errors(request.to_file == "-" ? "standard input" : request.to_file);
  std::size_t num_paths = 0;
  double shortest = std::numeric_limits<double>::infinity();
  std::vector<SourcePaths> drawn;
  auto json = nlohmann::ordered_json::array();
  std::string csv = request.header ? path_csv_header(request.columns) + "\n" : "";
  for (std::size_t s = 0; s < results.size(); ++s) {
    drawn.push_back({"from " + request.from[s], {}});
    for (std::size_t k = 0; k < results[s].size(); ++k, ++num_paths) {
      const PathResult& result = results[s][k];
      const std::string& problem = targets.problems[k];
      if (result.status != Status::ok) {
        const std::string source = results.size() > 1 ? fmt::format("from {}: ", request.from[s]) : "";
        errors.tell(targets.lines[k], source + (problem.empty() ? result.message : problem));
      }
      if (result.length > 0) shortest = std::min(shortest, result.length);
      if (result.points.cols() > 0) drawn.back().paths.push_back(&result);
      json.push_back(path_json(surface, result, request.options, request.surface_seconds, total));
      space_points(surface, result, request.samples_along, json.back());
      if (!problem.empty()) {
        json.back()["status"] = kBadInputStatus;
        json.back()["message"] = problem;
      }
      csv += path_csv(result, problem, request.columns) + "\n";
    }
  }
  const PathOutput output{.surface = surface,
                          .sources = std::move(drawn),
                          .json = {},
                          .facts = {{"sources", std::to_string(results.size())},
                                    {"paths", std::to_string(num_paths)},
                                    {"time", fmt::format("{:.3g} s", total)}},
                          .title = picture_title(request.surface),
                          .show = request.show,
                          .field = field_options(request.options),
                          .evenly_spaced = request.samples_along};
  // Pictures come first, so that their time is in the result; the result comes out even where they cannot be written.
  std::exception_ptr trouble;
  double all_seconds = total;
  const Timer picture_timer;
  try {
    write_paths(delivery.files, output, context);
  } catch (...) {
    trouble = std::current_exception();
  }
  clear_progress();
  if (delivery.files.has_picture()) {
    const double seconds = picture_timer.seconds();
    all_seconds += seconds;
    for (auto& path : json) add_picture_seconds(seconds, path);
  }
  if (delivery.json) {
    std::cout << json.dump() << "\n";
  } else {
    std::cout << csv;
  }
  tell_of_ignored_faces(surface, shortest, context);
  if (results.size() > 1) {
    context.tell(fmt::format("{} paths from {} sources in {:.3g} s", num_paths, results.size(), all_seconds));
  }
  if (trouble) std::rethrow_exception(trouble);
  write_json_files(delivery.files, json);
  return errors.any() ? kSomeLinesFailed : kDone;
}

}  // namespace taut::app
