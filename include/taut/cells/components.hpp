#pragma once

#include <cstdint>
#include <vector>

#include "taut/cells/cell_grid.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut {

/// Which cells hang together, corners included (3^d - 1 neighbours).
struct Components {
  static constexpr std::int32_t kNone = -1;
  /// By cell: its component, numbered in the order of their first cells; kNone = left out.
  std::vector<std::int32_t> label;
  std::int32_t count = 0;
};

/// Of all cells. Where the crossing test is rigorous (CrossingTest::rigorous) and the set complete, two points whose
/// cells have different labels lie on different components of the surface: a proof, since a path would pass through
/// closed cells that touch. The same label proves nothing.
[[nodiscard]] Components components(const CellGrid& grid);

/// Of all cells, hanging together across faces alone (2 d neighbours, in any dimension): what Algorithm II joins.
[[nodiscard]] Components components_across_faces(const CellGrid& grid);

/// Of the cells that marching may walk on: invalid ones are left out.
[[nodiscard]] Components components(const SurfaceCells& cells);

}  // namespace taut
