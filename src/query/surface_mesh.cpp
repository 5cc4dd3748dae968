// Meshes for pictures: cells fine enough to look smooth, their zero set by cells/mesh_surface, and edges of surfaces
// that are not smooth brought in afterwards. Sizes: as asked for; else half of what a search would take, or for fits
// what a budget of cells allows.
#include "taut/query/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "query/mesh_component.hpp"
#include "search/cell_levels.hpp"
#include "strata/facet_complex.hpp"
#include "strata/sharp_mesh.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

/// A dense fit takes 3 to 10 us a point, and a cell of a display mesh some five points: a second for so many.
constexpr Index kMostFittedCells = 20'000;
/// A formula takes a tenth of that. More triangles make a page heavy (40 bytes each), and no picture better.
constexpr Index kMostCells = 150'000;
/// Vertices of a mesh that is not exact lie within this of the surface, in cells.
constexpr double kRough = 2e-3;

/// The size at which about `most` cells hold the samples' surface. Counted at a size at which nearly every crossed cell
/// holds a sample; the number goes like h^-2.
double size_for_budget(const Points& samples, Index most) {
  constexpr double kCountedPerSide = 16;
  constexpr double kCrossedBesideSamples = 1.5;
  const Box box{samples.rowwise().minCoeff(), samples.rowwise().maxCoeff()};
  const double counted = box.extent().maxCoeff() / kCountedPerSide;
  CellGrid occupied(box.lower, counted);
  std::vector<std::int32_t> cell(static_cast<std::size_t>(samples.rows()));
  for (const auto& x : samples.colwise()) {
    occupied.cell_of(x, cell);
    occupied.insert(cell);
  }
  const double crossed = kCrossedBesideSamples * static_cast<double>(occupied.num_cells());
  return counted * std::sqrt(crossed / static_cast<double>(most));
}

/// The cells to look at, in `box`: those for marching would be too coarse.
CellGrid display_grid(const Surface& surface, const DisplayMeshOptions& options, const Context& context, Box& box) {
  const Points near = options.near.rows() == surface.dim() ? options.near : Points(surface.dim(), 0);
  const bool fitted = surface.samples() != nullptr && surface.samples()->size() > 0;
  const bool grown = fitted && options.grid != GridMethod::subdivide;
  const bool from_seeds = !fitted && options.grid == GridMethod::grow;
  const GridMethod method = grown || from_seeds ? GridMethod::grow : GridMethod::subdivide;
  detail::CellLevels levels(surface, {method, options.cell, options.seeds}, context);
  levels.prepare(near);
  box = levels.box();
  if (from_seeds) return levels.cells(options.cell > 0 ? 0 : 1, near)->grid();
  const double finest = options.cell_at_most > 0 ? options.cell_at_most : std::numeric_limits<double>::infinity();
  if (grown) {
    const Points& samples = surface.samples()->points;
    const double chosen = std::max(levels.size(1), size_for_budget(samples, kMostFittedCells));
    return grow(surface, samples, options.cell > 0 ? options.cell : std::min(chosen, finest), context);
  }
  const auto cells_of = [&](double h) {
    return subdivide(surface, {.size = h, .box = levels.box(), .origin = {}}, context);
  };
  if (options.cell > 0) return cells_of(options.cell);
  const std::shared_ptr<SurfaceCells> coarse = levels.cells(0, near);  // as fine as the surface bends
  // Half the size has four times the cells.
  const int level = 4 * coarse->num_cells() > kMostCells ? 0 : 1;
  if (level == 0 && levels.size(0) <= finest) return coarse->grid();
  return cells_of(std::min(levels.size(level), finest));
}

MeshOptions mesh_options(const DisplayMeshOptions& options, const CellGrid& grid) {
  return {.tolerance = options.exact ? 0 : kRough * grid.size()};
}

/// Not its seams: nobody sees them.
Polylines lines_of(const detail::FacetComplex& complex) {
  Polylines result;
  for (const detail::EdgeLine& line : complex.network.lines) {
    if (complex.surface->edge(line.edge).b >= 0 && line.angle <= detail::kSeamAngle) continue;
    Points points(3, static_cast<Index>(line.points.size()));
    for (std::size_t i = 0; i < line.points.size(); ++i) points.col(static_cast<Index>(i)) = line.points[i];
    result.lines.push_back(std::move(points));
  }
  return result;
}

}  // namespace

SurfaceMesh display_mesh(const Surface& surface, const DisplayMeshOptions& options, const Context& context) {
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument("only surfaces in 3 dimensions with one equation can be meshed, not " +
                          std::to_string(surface.dim()) + " dimensions with " + std::to_string(surface.codim()));
  }
  Box box;
  const CellGrid grid = display_grid(surface, options, context, box);
  SurfaceMesh mesh = mesh_surface(surface, grid, mesh_options(options, grid), context);
  if (mesh.faces.cols() == 0) {
    throw EmptySurface("the surface has no piece that these cells can show; try smaller ones");
  }
  if (std::optional<detail::FacetComplex> complex = detail::FacetComplex::of(surface, box, context)) {
    detail::sharpen_mesh(*complex->surface, complex->network, grid, options.part_faces, mesh);
    mesh.edges = lines_of(*complex);
  }
  if (options.component != 0) detail::keep_component(mesh, options.component);
  return mesh;
}

CurveMesh display_curve(const Surface& surface, const DisplayMeshOptions& options, const Context& context) {
  if (surface.dim() != 2 || surface.codim() != 1) {
    throw InvalidArgument("only curves in the plane with one equation can be drawn, not " +
                          std::to_string(surface.dim()) + " dimensions with " + std::to_string(surface.codim()));
  }
  Box box;
  const CellGrid grid = display_grid(surface, options, context, box);
  CurveMesh curve = mesh_curve(surface, grid, mesh_options(options, grid), context);
  if (curve.segments.cols() == 0) {
    throw EmptySurface("the curve has no piece that these cells can show; try smaller ones");
  }
  return curve;
}

}  // namespace taut
