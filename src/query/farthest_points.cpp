// Gonzalez' rule: each new point is the one farthest from those chosen so far, so that n points cover the surface
// within twice the least radius that any n could.
// Farthest-point sampling by marched distances: each march goes only as far as the new point may be the nearest.

#include "taut/query/point_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "march/mesh_march.hpp"
#include "search/cell_levels.hpp"
#include "strata/faceted_surface.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"
#include "taut/march/march.hpp"
#include "taut/query/surface_mesh.hpp"

namespace taut {

FarthestPoints farthest_points(const Surface& surface, SurfaceCells& cells, const VectorIn& first, Index count,
                               const Context& context) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FarthestPoints chosen{.points = Points(surface.dim(), count),
                        .distance = Vector::Constant(cells.num_cells(), kInfinity),
                        .nearest = std::vector<Index>(static_cast<std::size_t>(cells.num_cells()), -1),
                        .cover = {}};
  Vector next = first;
  for (Index k = 0; k < count; ++k) {
    chosen.points.col(k) = next;
    // No cell beyond what was farthest so far can come nearer.
    MarchOptions options;
    if (!chosen.cover.empty()) options.radius = chosen.cover.back();
    const DistanceField field = march(surface, cells, next, options, context);
    Index farthest = -1;
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (field.distance(i) < chosen.distance(i)) {
        chosen.distance(i) = field.distance(i);
        chosen.nearest[static_cast<std::size_t>(i)] = k;
      }
      if (!std::isfinite(chosen.distance(i))) continue;
      // Of equal ones the first: the same points in every run.
      if (farthest < 0 || chosen.distance(i) > chosen.distance(farthest)) farthest = i;
    }
    chosen.cover.push_back(farthest < 0 ? 0 : chosen.distance(farthest));
    context.report("sample", static_cast<double>(k + 1) / static_cast<double>(count));
    if (chosen.cover.back() == 0) {  // every cell is one of them
      chosen.points.conservativeResize(Eigen::NoChange, k + 1);
      break;
    }
    next = cells.point(farthest);
  }
  return chosen;
}

namespace {

/// Vertices of the mesh, by distances over its triangles: cells are not marched across edges.
FarthestPoints over_edges(const Surface& surface, const Vector& start, Index count,
                          const FarthestPointsOptions& options, const Context& context) {
  const SurfaceMesh mesh = display_mesh(
      surface, {.cell = options.cell, .grid = options.grid, .near = start, .seeds = options.seeds}, context);
  detail::MeshMarch march(mesh);
  FarthestPoints chosen{.points = Points(3, count), .distance = {}, .nearest = {}, .cover = {}};
  Vector next = start;
  for (Index k = 0; k < count; ++k) {
    chosen.points.col(k) = next;
    march.add_source(next, context);
    Index farthest = -1;
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
      const double distance = march.distance()(v);
      if (std::isfinite(distance) && (farthest < 0 || distance > march.distance()(farthest))) farthest = v;
    }
    if (farthest < 0) {
      throw InvalidArgument("farthest points: the first point reaches no vertex of the mesh; ask for smaller cells");
    }
    chosen.cover.push_back(march.distance()(farthest));
    context.report("sample", static_cast<double>(k + 1) / static_cast<double>(count));
    if (chosen.cover.back() == 0) {
      chosen.points.conservativeResize(Eigen::NoChange, k + 1);
      break;
    }
    next = mesh.vertices.col(farthest);
  }
  chosen.distance = march.distance();
  chosen.nearest.assign(march.source().begin(), march.source().end());
  return chosen;
}

}  // namespace

FarthestPoints farthest_points(const Surface& surface, const VectorIn& first, Index count,
                               const FarthestPointsOptions& options, const Context& context) {
  if (count < 1) throw InvalidArgument("farthest points: ask for one or more");
  if (first.size() > 0) detail::check_point(surface, first, "first point");
  detail::CellLevels levels(surface, {options.grid, options.cell, options.seeds}, context);
  if (!levels.exist() || levels.lazy()) {
    throw InvalidArgument("farthest points are chosen on cells, which are made in up to 6 dimensions");
  }
  // Without a first point the box is found from the seeds, or from the surface alone.
  const Points seeds = options.seeds.cols() > 0 ? options.seeds : Points(surface.dim(), 0);
  levels.prepare(first.size() > 0 ? Points(first) : seeds);
  Vector start;
  if (first.size() > 0) {
    start = levels.on_surface(first, "first point");
  } else {
    const std::shared_ptr<SurfaceCells> any = levels.cells(0, seeds);
    // Any point of the surface will do to begin with: the first cell's.
    for (Index i = 0; i < any->num_cells() && start.size() == 0; ++i) {
      if (any->valid(i)) start = any->point(i);
    }
    if (start.size() == 0) throw EmptySurface("no surface was found to spread points over");
  }
  if (detail::is_kinked(surface)) return over_edges(surface, start, count, options, context);
  // Points are cells: too few cells would make them crowd.
  constexpr Index kCellsPerPoint = 24;
  std::shared_ptr<SurfaceCells> cells = levels.cells(0, start);
  for (int level = 1; level < levels.num_levels() && options.cell == 0; ++level) {
    if (cells->num_cells() >= kCellsPerPoint * count) break;
    cells = levels.cells(level, start);
  }
  return farthest_points(surface, *cells, start, count, context);
}

}  // namespace taut
