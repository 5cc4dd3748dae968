#pragma once

#include <memory>

#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Cells with the surface point and normals that stand for each: what marching walks on. Either complete (all cells are
/// there) or lazy (Algorithm II run only where somebody asks for neighbours).
class SurfaceCells {
 public:
  /// Complete: projects the centre of every cell of `grid` onto the surface, in parallel.
  SurfaceCells(const Surface& surface, CellGrid grid, const Context& context = {});
  /// Lazy: starts with the cells that hold `seeds` (d x n surface points). Throws EmptySurface when none is crossed.
  [[nodiscard]] static SurfaceCells lazy(const Surface& surface, const PointsIn& seeds, double size,
                                         const Context& context = {});

  [[nodiscard]] const CellGrid& grid() const;
  [[nodiscard]] Index num_cells() const { return grid().num_cells(); }
  [[nodiscard]] Eigen::Map<const Vector> point(Index i) const;   ///< d: the projected centre
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> normals(Index i) const;  ///< d x k, orthonormal columns
  /// False where the projection failed, went farther than about a cell, or left the domain: such cells are not walked.
  [[nodiscard]] bool valid(Index i) const;

  /// After it, every one of the 3^d - 1 neighbours of cell i that the surface crosses is present. May move memory:
  /// maps returned by point() and normals() end their life here. Does nothing on a complete set.
  void expand(Index i);
};

}  // namespace taut
