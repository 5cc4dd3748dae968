// Figure 6: one source to all destinations on a face, on the cells and on the surface.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cell_faces.hpp"
#include "models.hpp"
#include "parts.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/march/march.hpp"
#include "taut/query/field.hpp"
#include "taut/query/path.hpp"
#include "taut/query/point_sets.hpp"
#include "taut/surface/projection.hpp"

namespace taut::paper {
namespace {

constexpr Index kDestinations = 36;

/// The sample that stands out most to the front: the tip of the nose.
Vector foremost_sample(const Model& face) {
  const Eigen::Vector3d front = face.is_real ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  Index best = 0;
  (face.cloud.points.transpose() * front).maxCoeff(&best);
  return face.cloud.points.col(best);
}

}  // namespace

void write_figure6(Study& study, Report& report) {
  const Model& face = model(study, ModelKind::face);
  Section& section = report.section("Figure 6");
  section.paper(
      "A human face, acquired as a point cloud and made into an implicit surface with radial basis functions; "
      "Algorithm II "
      "makes the cells. Shown are the geodesics from one source to all destinations, on the grid (a) and on the "
      "surface (b), "
      "and a colour bar of the geodesic distance.");
  section.text(fmt::format("The face here: {}, {} points.", escape_markup(face.origin), face.cloud.size()));

  const Vector nose = foremost_sample(face);
  const double size = (face.cloud.points.rowwise().maxCoeff() - face.cloud.points.rowwise().minCoeff()).norm();
  const double cell = 0.022 * size;

  // (a) The paper's own step: Algorithm II from the samples, then fast marching between the cells.
  const ProcessorClock grid_clock;
  SurfaceCells cells(face.surface, grow(face.surface, face.cloud.points, cell, study.context), study.context);
  const ProjectionResult source = project_to_surface(face.surface, nose);
  const DistanceField on_cells = march(face.surface, cells, source.point, {.method = MarchMethod::axis}, study.context);
  const double grid_seconds = grid_clock.seconds();
  std::vector<Index> reached;
  for (Index i = 0; i < on_cells.distance.size(); ++i) {
    if (std::isfinite(on_cells.distance(i))) reached.push_back(i);
  }
  Points centres(3, static_cast<Index>(reached.size()));
  Vector distances(centres.cols());
  for (Index j = 0; j < centres.cols(); ++j) {
    centres.col(j) = cells.grid().centre(reached[static_cast<std::size_t>(j)]);
    distances(j) = on_cells.distance(reached[static_cast<std::size_t>(j)]);
  }
  Scene grid_scene;
  grid_scene.title = "(a) On the Cartesian grid";
  grid_scene.up = face.up;
  grid_scene.meshes.push_back({.mesh = cell_faces(centres, cell, distances, "distance"), .coloured_by = "distance"});

  // (b) The field on the surface, and a path to every destination.
  const FieldResult field = marched_field(face.surface, source.point, {}, study.context);
  const Points destinations = farthest_points(face.surface, cells, source.point, kDestinations + 1, study.context)
                                  .points.rightCols(kDestinations);
  const ProcessorClock path_clock;
  PathSolver solver(face.surface, {.method = CorrectionMethod::flow, .march = MarchMethod::axis, .cell = cell},
                    study.context);
  const std::vector<PathResult> paths = solver.solve_from(source.point, destinations);
  const double path_seconds = path_clock.seconds();
  PathSolver exact(face.surface, {}, study.context);
  const ProcessorClock exact_clock;
  const std::vector<PathResult> newton = exact.solve_from(source.point, destinations);
  const double exact_seconds = exact_clock.seconds();

  Scene surface_scene;
  surface_scene.title = "(b) On the surface";
  surface_scene.up = face.up;
  surface_scene.meshes.push_back({.mesh = field.mesh, .coloured_by = "distance"});
  Table table{
      .name = "figure6_paths",
      .title = fmt::format("From the tip of the nose to {} destinations, farthest from each other", kDestinations),
      .columns = {{"destination"},
                  {"marched on cells", "{:.5f}"},
                  {"chain with flow", "{:.6f}"},
                  {"status"},
                  {"Newton", "{:.8f}"},
                  {"its error estimate", "{:.1e}"},
                  {"marched / Newton − 1", "{:.3f}"},
                  {"flow / Newton − 1", "{:.1e}"}}};
  const Vector marched_distance = distance_at(face.surface, cells, on_cells, destinations);
  double mean_bias = 0;
  constexpr double kSame = 1e-4;  // of the length: the flow's own error is a fifth of it
  double worst_flow = 0;          // of the same geodesic
  double most_longer = 0;         // of another one
  Index agreed = 0;
  Index same = 0;
  for (std::size_t j = 0; j < paths.size(); ++j) {
    const bool have = paths[j].points.cols() > 1 && newton[j].status == Status::ok;
    if (newton[j].points.cols() > 1) {
      surface_scene.paths.push_back({.points = newton[j].points,
                                     .label = "geodesics",
                                     .colour = Colour::hex(0xffffff),
                                     .length = newton[j].length,
                                     .width = 0.7});
    }
    const double distance = marched_distance(static_cast<Index>(j));
    const double marched = distance / newton[j].length - 1;
    const double flow = paths[j].length / newton[j].length - 1;
    table.add({static_cast<Index>(j + 1), distance, paths[j].length, std::string(to_string(paths[j].status)),
               newton[j].length, newton[j].length_error, have ? Value(marched) : Value(),
               have ? Value(flow) : Value()});
    if (!have || !std::isfinite(marched)) continue;
    ++agreed;
    mean_bias += marched;
    if (std::abs(flow) <= kSame) {
      ++same;
      worst_flow = std::max(worst_flow, std::abs(flow));
    } else {
      most_longer = std::max(most_longer, flow);
    }
  }
  surface_scene.points.push_back({.position = source.point, .label = "source", .colour = kRed});
  const PictureOptions portrait{.width = 560, .height = 680, .towards_viewer = face.towards_viewer};
  std::vector<Figure> pictures;
  pictures.push_back(
      figure_of("figure6a_cells",
                fmt::format("{} cells of size {:.4g} by Algorithm II, coloured by the marched distance from the nose.",
                            cells.num_cells(), cell),
                grid_scene, portrait));
  pictures.push_back(figure_of(
      "figure6b_surface",
      fmt::format("The surface, coloured by the distance, with the geodesics to {} destinations.", kDestinations),
      surface_scene, portrait));
  section.add_row(std::move(pictures));
  section.measured(fmt::format(
      "Cells and march take {:.2f} s. The paper's chain to {} destinations takes {:.1f} s, Newton's method with Taut's "
      "own "
      "march {:.1f} s. The distances marched on the cells are {:.1f} % {} than the geodesics in the mean. After the "
      "correction {} of {} paths are the geodesics that Newton's method finds, to {} of the length{}",
      grid_seconds, kDestinations, path_seconds, exact_seconds, 100 * std::abs(mean_bias) / std::max<Index>(agreed, 1),
      mean_bias < 0 ? "shorter" : "longer", same, agreed, readable_number(worst_flow, "{:.1e}"),
      same == agreed
          ? std::string(".")
          : fmt::format("; the others are longer ones, by up to {} %: distances that are so far off lead the wrong way "
                        "round a bump, and a correction stays on that way.",
                        readable_number(100 * most_longer, "{:.1f}"))));
  section.add(table);
  section.remark(
      "In its text the paper says that Figure 6 shows the hand, the pot and the sculpture; Figure 7 is meant. The face "
      "of the "
      "paper comes from a collection that may not be passed on, so another one stands here.");
}

}  // namespace taut::paper
