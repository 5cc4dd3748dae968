#include "path_lines.hpp"

#include <cmath>
#include <utility>

#include "report.hpp"
#include "taut/curve/spectral_curve.hpp"

namespace taut::app {
namespace {

Points path_points(const Surface& surface, const PathResult& path, Index evenly_spaced) {
  return evenly_spaced > 0 && path.points.cols() > 1 ? taut::evenly_spaced(surface, path.points, evenly_spaced)
                                                     : path.points;
}

}  // namespace

void space_points(const Surface& surface, const PathResult& path, Index evenly_spaced, nlohmann::ordered_json& json) {
  if (evenly_spaced > 0) json["points"] = points_json(path_points(surface, path, evenly_spaced));
}

PathLines path_lines(const Surface& surface, const std::vector<const PathResult*>& paths, Index evenly_spaced) {
  PathLines result;
  for (const PathResult* path : paths) result.lines.lines.push_back(path_points(surface, *path, evenly_spaced));
  const Index n = result.lines.num_points();
  VertexScalar arc_length{.name = "arc_length", .values = Vector(n)};
  const bool hypersurface = surface.codim() == 1;
  result.normals.resize(surface.dim(), hypersurface ? n : 0);
  Index next = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Points& line = result.lines.lines[i];
    // Points that were spaced evenly lie too far apart to measure the curve between them.
    Vector along = evenly_spaced > 0 ? Vector(Vector::LinSpaced(line.cols(), 0, 1)) : arc_lengths(line);
    // What is left between the two lengths is the spacing's: the path's own length is the accurate one.
    const bool known = along.size() > 0 && along(along.size() - 1) > 0 && std::isfinite(paths[i]->length);
    if (known) along *= paths[i]->length / along(along.size() - 1);
    arc_length.values.segment(next, line.cols()) = along;
    if (hypersurface) result.normals.middleCols(next, line.cols()) = surface.jacobian(line).colwise().normalized();
    next += line.cols();
  }
  result.lines.scalars.push_back(std::move(arc_length));
  return result;
}

}  // namespace taut::app
