#include "taut/query/field.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "search/cell_levels.hpp"
#include "search/check_options.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"
#include "taut/query/surface_mesh.hpp"

namespace taut {

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

  if (levels.endless()) {
    context.tell("the surface goes on beyond " + detail::text_of(levels.box()) +
                 ": distances are along paths that stay in there");
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

  result.mesh = display_mesh(
      surface, {.cell_at_most = options.cell, .grid = options.grid, .near = on_surface, .seeds = options.seeds},
      context);
  VertexScalar distance{"distance", distance_at(surface, cells, field, result.mesh.vertices)};
  for (double& u : distance.values) {
    if (!std::isfinite(u)) u = std::numeric_limits<double>::quiet_NaN();
  }
  result.mesh.scalars.push_back(std::move(distance));
  return result;
}

}  // namespace taut
