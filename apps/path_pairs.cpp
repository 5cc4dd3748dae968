#include "path_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <vector>

#include "batch_errors.hpp"
#include "batch_output.hpp"
#include "ignored_faces.hpp"
#include "number_rows.hpp"
#include "pairs_file.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_points.hpp"

namespace taut::app {
namespace {

/// Pairs in one go: enough for all cores, and no more than half a second's work to lose.
constexpr Index kFirstChunk = 32;
constexpr Index kLargestChunk = 8192;
constexpr double kChunkSeconds = 0.5;

/// How many pairs there are and where they lie, so that neither how they are cut into chunks nor how often they were
/// resumed has a say in any result.
struct Survey {
  Index count = 0;
  Points corners;  // d x 2
};

Survey survey(const PairsFile& file, const Surface& surface) {
  const Index d = surface.dim();
  Survey found;
  found.corners.resize(d, 2);
  found.corners.col(0).setConstant(std::numeric_limits<double>::infinity());
  found.corners.col(1).setConstant(-std::numeric_limits<double>::infinity());
  CsvRows rows = file.rows(surface);
  for (CsvRow row; rows.next(row); ++found.count) {
    if (!row.problem.empty() || static_cast<Index>(row.values.size()) != 2 * d) continue;
    const Eigen::Map<const Points> ends(row.values.data(), d, 2);
    found.corners.col(0) = found.corners.col(0).cwiseMin(ends.rowwise().minCoeff());
    found.corners.col(1) = found.corners.col(1).cwiseMax(ends.rowwise().maxCoeff());
  }
  return found;
}

/// One line that stands for the request: a file of results made under another one is not continued.
std::string request_line(const PairsRequest& request, const PairsFile& file) {
  const PathOptions& options = request.options;
  std::string line = fmt::format(
      "taut path {} --pairs {} ({}) {} {} {} {} {} {} {} {} {} {} {} {}", request.surface, file.name(), file.version(),
      to_string(options.method), static_cast<int>(options.march), static_cast<int>(options.grid), options.envelope,
      options.cell, options.tolerance, options.spacing, options.beta, static_cast<int>(options.flow_step),
      static_cast<int>(options.flow_nodes), options.all, request.columns.unique);
  std::ranges::replace(line, '\n', ' ');
  return line;
}

}  // namespace

ExitCode answer_pairs(const PairsRequest& request, const Surface& surface, const Context& context) {
  const Index d = surface.dim();
  const PairsFile file(request.file, context);
  const Survey found = survey(file, surface);
  const std::string header = request.header ? path_csv_header(request.columns) : "";
  const std::unique_ptr<BatchOutput> output =
      request.out ? std::make_unique<BatchOutput>(*request.out, request_line(request, file), header)
                  : std::make_unique<BatchOutput>(header);
  BatchErrors errors(file.name());
  const bool ok_before = !output->some_failed();
  CsvRows rows = file.rows(surface);
  Index done = 0;
  const auto num_earlier = static_cast<Index>(output->num_done());
  for (CsvRow row; done < num_earlier && rows.next(row);) ++done;
  if (done > 0)
    context.tell(fmt::format("going on after {} of {} pairs, which an earlier run has answered", done, found.count));

  // Inside a chunk the bar shows the whole.
  Context whole = context;
  if (context.progress) {
    whole.progress = [&](std::string_view stage, double) {
      context.progress(stage, found.count > 0 ? static_cast<double>(done) / static_cast<double>(found.count) : 1);
    };
  }
  PathSolver solver(surface, request.options, whole);
  if (found.corners.allFinite()) solver.expect(found.corners, found.count);
  double shortest = std::numeric_limits<double>::infinity();
  Index size = kFirstChunk;
  using Clock = std::chrono::steady_clock;
  const std::string takes = fmt::format("a pair takes {}, p1,...,pd,q1,...,qd", 2 * d);
  for (;;) {
    const NumberRows chunk = read_number_rows(rows, 2 * d, size, takes);
    if (chunk.size() == 0) break;
    const auto start = Clock::now();
    const std::vector<PathResult> results = solver.solve_pairs(chunk.values.topRows(d), chunk.values.bottomRows(d));
    std::string lines;
    for (std::size_t k = 0; k < results.size(); ++k) {
      const PathResult& result = results[k];
      const std::string& problem = chunk.problems[k];
      lines += path_csv(result, problem, request.columns) + "\n";
      if (result.length > 0) shortest = std::min(shortest, result.length);
      if (result.status != Status::ok) errors.tell(chunk.lines[k], problem.empty() ? result.message : problem);
    }
    output->write(lines);
    done += static_cast<Index>(results.size());
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double fitting = static_cast<double>(chunk.lines.size()) * kChunkSeconds / std::max(seconds, 1e-3);
    size = std::clamp(static_cast<Index>(fitting), Index{8}, std::min(kLargestChunk, 2 * size));
  }
  output->finish();
  tell_of_ignored_faces(surface, shortest, context);
  return ok_before && !errors.any() ? kDone : kSomeLinesFailed;
}

}  // namespace taut::app
