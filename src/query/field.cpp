// Marched distances from several sources, over cells or, on surfaces with edges, over the triangles of the display
// mesh. For surfaces in space they are read at the mesh's vertices too, so that they can be shown. Errors:
// docs/march.md; exact distances are DistanceSolver's.
#include "taut/query/field.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "march/mesh_march.hpp"
#include "search/cell_levels.hpp"
#include "search/check_options.hpp"
#include "strata/faceted_surface.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"
#include "taut/query/surface_mesh.hpp"

namespace taut {

namespace {

SurfaceMesh mesh_for(const Surface& surface, const Points& sources, const FieldOptions& options,
                     const Context& context) {
  return display_mesh(
      surface, {.cell_at_most = options.cell, .grid = options.grid, .near = sources, .seeds = options.seeds}, context);
}

/// Puts distances onto the mesh: NaN where no path leads.
void show(Vector distance, SurfaceMesh& mesh) {
  for (double& u : distance) {
    if (!std::isfinite(u)) u = std::numeric_limits<double>::quiet_NaN();
  }
  mesh.scalars.push_back({"distance", std::move(distance)});
}

/// Cells are not marched across edges; the mesh has them.
FieldResult march_over_edges(const Surface& surface, const Points& sources, const FieldOptions& options,
                             const Context& context) {
  FieldResult result;
  result.over_mesh = true;
  result.mesh = mesh_for(surface, sources, options, context);
  detail::MeshMarch march(result.mesh);
  for (const auto& source : sources.colwise()) march.add_source(source, context);
  result.points = result.mesh.vertices;
  result.distance = march.distance();
  show(march.distance(), result.mesh);
  return result;
}

}  // namespace

FieldResult marched_field(const Surface& surface, const PointsIn& sources, const FieldOptions& options,
                          const Context& context) {
  detail::check_envelope(options.envelope, options.march);
  if (sources.cols() == 0) throw InvalidArgument("a distance field needs at least one source");
  for (Index j = 0; j < sources.cols(); ++j) detail::check_point(surface, sources.col(j), "source");
  detail::CellLevels levels(surface, {options.grid, options.cell, options.seeds}, context);
  if (!levels.exist()) {
    throw InvalidArgument("distances are marched on cells, which are made in up to 6 dimensions, not in " +
                          std::to_string(surface.dim()) + ", unless they are grown (Algorithm II)");
  }
  if (levels.lazy() && options.march != MarchMethod::axis) {
    throw InvalidArgument("in more than 6 dimensions cells are marched across faces only: ask for the axis march");
  }
  levels.prepare(sources);
  Points on_surface(sources.rows(), sources.cols());
  for (Index j = 0; j < sources.cols(); ++j) on_surface.col(j) = levels.on_surface(sources.col(j), "source");

  // A shorter way may run outside the box: said once.
  if (levels.endless()) {
    context.tell("the surface goes on beyond " + detail::text_of(levels.box()) +
                 ": distances are along paths that stay in there");
  }

  // The paper's marches step across edges as over any cells; they are kept for comparison.
  if (options.march == MarchMethod::convergent && options.envelope == 0 && detail::is_kinked(surface)) {
    return march_over_edges(surface, on_surface, options, context);
  }
  const std::shared_ptr<SurfaceCells> shared =
      options.envelope == 0 ? levels.cells(0, on_surface) : levels.envelope(0, options.envelope);
  SurfaceCells& cells = *shared;
  const DistanceField field =
      march(surface, cells, on_surface, MarchOptions{.method = options.march, .target = {}}, context);
  FieldResult result;
  result.cell = cells.grid().size();
  result.num_cells = cells.num_cells();
  result.num_layers = cells.num_layers();
  result.grid = levels.grid();
  result.distance = field.distance;
  result.points.resize(surface.dim(), cells.num_cells());
  for (Index i = 0; i < cells.num_cells(); ++i) {
    if (field.at_centres) {
      result.points.col(i) = cells.grid().centre(i);
    } else {
      result.points.col(i) = cells.point(i);
    }
  }
  if (surface.dim() != 3 || surface.codim() != 1) return result;

  result.mesh = mesh_for(surface, on_surface, options, context);
  show(distance_at(surface, cells, field, result.mesh.vertices), result.mesh);
  return result;
}

}  // namespace taut
