#include "taut/query/surface_mesh.hpp"

#include <string>

#include "query/cell_levels.hpp"
#include "taut/core/error.hpp"

namespace taut {

SurfaceMesh display_mesh(const Surface& surface, const DisplayMeshOptions& options, const Context& context) {
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument("only surfaces in 3 dimensions with one equation can be meshed, not " +
                          std::to_string(surface.dim()) + " dimensions with " + std::to_string(surface.codim()));
  }
  detail::CellLevels levels(surface, options.grid, options.cell, context);
  levels.prepare(Points(surface.dim(), 0));
  // Cells chosen for marching are too coarse to look at.
  const int level = options.cell > 0 ? 0 : 1;
  const SurfaceMesh mesh = mesh_surface(surface, levels.cells(level, Points(surface.dim(), 0))->grid(), {}, context);
  if (mesh.faces.cols() == 0) {
    throw EmptySurface("the surface has no piece that these cells can show; try smaller ones");
  }
  return mesh;
}

Points display_cells(const Surface& surface, const DisplayMeshOptions& options, const Context& context) {
  detail::CellLevels levels(surface, options.grid, options.cell, context);
  if (!levels.exist()) {
    throw InvalidArgument("cells are made in up to 6 dimensions, not in " + std::to_string(surface.dim()));
  }
  levels.prepare(Points(surface.dim(), 0));
  const std::shared_ptr<SurfaceCells> cells = levels.cells(0, Points(surface.dim(), 0));
  Points centres(surface.dim(), cells->num_valid());
  Index count = 0;
  for (Index i = 0; i < cells->num_cells(); ++i) {
    if (cells->valid(i)) centres.col(count++) = cells->grid().centre(i);
  }
  return centres;
}

}  // namespace taut
