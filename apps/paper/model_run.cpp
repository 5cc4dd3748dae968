#include "model_run.hpp"

#include <cmath>

#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/query/point_sets.hpp"

namespace taut::paper {
namespace {

constexpr Index kDestinations = 8;

MethodRun run_method(const Model& model, const ModelRun& setting, const PathOptions& options, const Context& context) {
  MethodRun run;
  const ProcessorClock clock;
  PathSolver solver(model.surface, options, context);
  for (const auto& source : setting.sources.colwise()) {
    for (PathResult& path : solver.solve_from(source, setting.destinations)) run.paths.push_back(std::move(path));
  }
  run.seconds = clock.seconds();
  return run;
}

}  // namespace

double cell_for_count(const Model& model, Index wanted_cells, const Context& context) {
  const Points& points = model.cloud.points;
  const Vector extent = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  // The count falls about as the square of the size.
  double cell = extent.norm() / 20;
  double best = cell;
  Index closest = -1;
  constexpr int kTries = 12;
  for (int i = 0; i < kTries; ++i) {
    const Index count = grow(model.surface, points, cell, context).num_cells();
    if (closest < 0 || std::abs(count - wanted_cells) < std::abs(closest - wanted_cells)) {
      closest = count;
      best = cell;
    }
    if (count == wanted_cells) break;
    cell *= std::sqrt(static_cast<double>(count) / static_cast<double>(wanted_cells));
  }
  return best;
}

const ModelRun& model_run(Study& study, ModelKind kind, Index wanted_cells) {
  const Model& body = model(study, kind);
  std::shared_ptr<const ModelRun>& kept = study.runs[body.name];
  if (kept != nullptr) return *kept;

  ModelRun run;
  run.cell = cell_for_count(body, wanted_cells, study.context);
  const ProcessorClock clock;
  const CellGrid grid = grow(body.surface, body.cloud.points, run.cell, study.context);
  run.cells_seconds = clock.seconds();
  run.num_cells = grid.num_cells();

  // Sources and destinations far from each other, on cells fine enough to tell fingers apart.
  SurfaceCells cells(body.surface, grow(body.surface, body.cloud.points, 0.3 * run.cell, study.context), study.context);
  const Points places =
      farthest_points(body.surface, cells, cells.point(0), kSources + kDestinations, study.context).points;
  run.sources = places.leftCols(kSources);
  run.destinations = places.rightCols(kDestinations);

  run.flow = run_method(body, run, {.method = CorrectionMethod::flow, .march = MarchMethod::axis, .cell = run.cell},
                        study.context);
  run.newton = run_method(body, run, {.cell = run.cell}, study.context);
  run.fine = run_method(body, run, {}, study.context);
  kept = std::make_shared<const ModelRun>(std::move(run));
  return *kept;
}

}  // namespace taut::paper
