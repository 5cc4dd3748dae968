#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Cells with the surface point and normals that stand for each: what marching walks on. Either complete (all cells are
/// there) or lazy (Algorithm II run only where somebody asks for neighbours). Movable, not copyable.
class SurfaceCells {
 public:
  /// Complete: projects the centre of every cell of `grid` onto the surface, in parallel. Throws EmptySurface when no
  /// cell has a surface point.
  SurfaceCells(const Surface& surface, CellGrid grid, const Context& context = {});
  /// Lazy: starts with the cells around `seeds` (d x n surface points), on the lattice of lattice_origin(first seed,
  /// size). Throws EmptySurface when no seed lies in a cell with a surface point; OutOfMemory, also later, when there
  /// are more than `most_cells`.
  [[nodiscard]] static SurfaceCells lazy(const Surface& surface, const PointsIn& seeds, double size,
                                         const Context& context = {}, Index most_cells = CellGrid::kMaxCells);

  /// Complete cells with `layers` of others around them (`thicken`), for marches over cell centres. Those given keep
  /// their indices, points and normals; the others are not `valid`, since no surface point stands for them. Throws
  /// InvalidArgument for lazy cells.
  [[nodiscard]] SurfaceCells thickened(Index layers, const Context& context = {}) const;

  ~SurfaceCells();
  SurfaceCells(SurfaceCells&&) noexcept;
  SurfaceCells& operator=(SurfaceCells&&) noexcept;

  [[nodiscard]] const CellGrid& grid() const { return grid_; }
  [[nodiscard]] Index dim() const { return grid_.dim(); }
  [[nodiscard]] Index codim() const { return codim_; }
  [[nodiscard]] Index num_cells() const { return grid_.num_cells(); }
  [[nodiscard]] Index num_valid() const { return num_valid_; }
  [[nodiscard]] bool is_lazy() const { return growth_ != nullptr; }
  /// Layers around the cells that the surface may cross; 0 = none.
  [[nodiscard]] Index num_layers() const { return num_layers_; }

  /// d: the projected centre; the centre itself where not valid.
  [[nodiscard]] Eigen::Map<const Vector> point(Index i) const { return {points_.data() + i * dim(), dim()}; }
  /// d x k, orthonormal columns spanning the normal space (k = 1: grad F / |grad F|); zero where not valid.
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> normals(Index i) const {
    return {normals_.data() + i * dim() * codim_, dim(), codim_};
  }
  /// False where no surface point inside the domain was found as near to the centre of cell i as it is in cells that
  /// the surface crosses (conservative tests keep cells that it does not reach): such cells are not walked.
  [[nodiscard]] bool valid(Index i) const { return valid_[static_cast<std::size_t>(i)] != 0; }

  /// After it, every one of the 3^d - 1 neighbours of cell i that the surface may cross is present. May move memory:
  /// maps returned by point() and normals() end their life here. Does nothing on a complete set.
  void expand(Index i) { expand({&i, 1}); }
  /// The same for several cells in one visit of the evaluator: cheaper than one by one.
  void expand(std::span<const Index> cells);
  /// After it, every one of the 2 d neighbours of cell i across a face that the surface may cross is present: a step of
  /// Algorithm II. Otherwise as `expand`.
  void expand_faces(Index i);
  /// Indices of the 3^d - 1 neighbours of cell i, kNone where absent, in the order of CellGrid::neighbour_offset. A
  /// lazy set is not expanded by asking.
  void neighbours(Index i, std::span<Index> out) const { grid_.neighbours(i, out); }
  /// Index of the cell that holds x, or kNone. A lazy set looks whether the surface crosses that cell.
  Index cell_at(const VectorIn& x);

  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Growth;

  SurfaceCells(CellGrid grid, Index codim, std::unique_ptr<Growth> growth);
  void project_new(const Surface& surface, const Context& context);
  void resolve_tiles();

  CellGrid grid_;
  Index codim_;
  Index num_valid_ = 0;
  Index num_layers_ = 0;
  std::vector<double> points_;       // d x n
  std::vector<double> normals_;      // d k x n
  std::vector<std::uint8_t> valid_;  // n
  std::unique_ptr<Growth> growth_;   // null = complete
};

}  // namespace taut
