#pragma once

#include <cstdint>
#include <vector>

#include "march/neighbour_index.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Where a surface in R^3 bends round less than two thirds of a cell: ways past such places are marched wrongly. Two
/// sheets back to back do not count.
class SharpBends {
 public:
  /// Looks at all cells, which must stay. `neighbours`: theirs.
  SharpBends(const SurfaceCells& cells, const NeighbourIndex<3>& neighbours, const Context& context);

  /// Is there such a place next to a curve (3 x m) on the surface.
  [[nodiscard]] bool along(const PointsIn& curve) const;

 private:
  const SurfaceCells& cells_;
  std::vector<std::uint8_t> near_;  // is a cell, or one around it, where the surface bends so
};

}  // namespace taut::detail
