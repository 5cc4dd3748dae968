// The entrance to all marches: checks the request, takes the normals at sources and target, and hands it to the method.
// The convergent march of one source over mapped cells of a surface runs in charts, in single precision; several
// sources, a radius, lazy cells and other dimensions take the march in double precision.
#include "taut/march/march.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "march/chart_march.hpp"
#include "march/march_over.hpp"
#include "march/methods.hpp"
#include "march/point_normals.hpp"
#include "march/tangent_coordinates.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

// Checks points (d x n) named `name`; returns bases of their normal spaces.
Points checked_normals(const Surface& surface, const PointsIn& x, const std::string& name) {
  if (x.rows() != surface.dim()) {
    throw InvalidArgument(name + " has " + std::to_string(x.rows()) + " coordinates, the surface lies in dimension " +
                          std::to_string(surface.dim()));
  }
  if (!x.allFinite()) throw InvalidArgument(name + " is not finite");
  Points normals = detail::normals_at(surface, x);
  for (Index j = 0; j < x.cols(); ++j) {
    if (!normals.col(j).allFinite()) {
      throw SingularPoint(name + " " + detail::describe(x.col(j)) + " is a singular point of the surface");
    }
  }
  return normals;
}

}  // namespace

DistanceField detail::march_over(const Surface& surface, SurfaceCells& cells, const CellMap* map,
                                 const PointsIn& sources, const MarchOptions& options, const Context& context) {
  if (surface.dim() != cells.grid().dim()) throw InvalidArgument("the cells belong to another surface");
  if (surface.dim() > detail::kMaxMarchDim && options.method != MarchMethod::axis) {
    throw InvalidArgument("dimension " + std::to_string(surface.dim()) + ": cells are marched up to dimension " +
                          std::to_string(detail::kMaxMarchDim));
  }
  if (!(options.radius >= 0)) throw InvalidArgument("the march's radius must be a length >= 0");
  if (sources.cols() == 0) throw InvalidArgument("no source given");
  DistanceField field;
  field.method = options.method;
  // The paper's walk over an envelope runs between all centres, also of cells that the surface does not cross.
  field.at_centres =
      options.method == MarchMethod::axis || (options.method == MarchMethod::dijkstra && cells.num_layers() > 0);
  field.sources = sources;
  field.source_normals = checked_normals(surface, sources, "source");
  field.target_distance = std::numeric_limits<double>::quiet_NaN();
  detail::MarchTask task{cells, options, context, {}, map};
  if (options.target) task.target_normals = checked_normals(surface, *options.target, "target").col(0);
  context.check_cancelled();
  switch (options.method) {
    case MarchMethod::convergent:
      // The march in charts knows neither a second source nor a radius.
      if (map != nullptr && map->charts && sources.cols() == 1 && std::isinf(options.radius)) {
        detail::march_in_charts(task, *map->charts, field);
      } else {
        detail::march_convergent(task, field);
      }
      break;
    case MarchMethod::axis: detail::march_axis(task, field); break;
    case MarchMethod::dijkstra: detail::march_dijkstra(task, field); break;
  }
  return field;
}

DistanceField march(const Surface& surface, SurfaceCells& cells, const PointsIn& sources, const MarchOptions& options,
                    const Context& context) {
  return detail::march_over(surface, cells, nullptr, sources, options, context);
}

}  // namespace taut
