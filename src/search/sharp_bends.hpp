#pragma once

#include <cstdint>
#include <vector>

#include "march/neighbour_index.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Where a surface in R^3 bends round about a cell or less: ways past such places are marched wrongly. Two sheets back
/// to back do not count.
class SharpBends {
 public:
  /// Looks at all cells, which must stay, like the surface. `neighbours`: of the cells.
  SharpBends(const Surface& surface, const SurfaceCells& cells, const NeighbourIndex<3>& neighbours,
             const Context& context);

  /// Is there such a place in any cell.
  [[nodiscard]] bool any() const { return any_; }
  /// For each point x (3 x m) of the surface 1 if it lies next to such a place, by the cells, or in one, by how fast
  /// the normal turns at the point itself: opposite sides of a needle look like two sheets to cells. Else 0.
  [[nodiscard]] std::vector<std::uint8_t> at(const PointsIn& x) const;
  /// Is there such a place at any point of a curve (3 x m) on the surface.
  [[nodiscard]] bool along(const PointsIn& curve) const;

 private:
  [[nodiscard]] bool is_near(const VectorIn& x) const;

  const Surface& surface_;
  const SurfaceCells& cells_;
  std::vector<std::uint8_t> near_;  // is a cell, or one around it, where the surface bends so
  bool any_ = false;
};

}  // namespace taut::detail
