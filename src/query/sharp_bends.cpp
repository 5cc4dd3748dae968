#include "query/sharp_bends.hpp"

#include <algorithm>
#include <cmath>

#include "cells/normal_turn.hpp"
#include "core/parallel.hpp"

namespace taut::detail {
namespace {

/// Radians over a cell's size.
constexpr double kSharp = 1.5;
/// Beyond this the two normals belong to two sheets.
constexpr double kMostTurn = 2.2;
/// Points this many cells apart tell.
constexpr double kNearest = 0.3;
constexpr double kFarthest = 1.5;
/// The turn of nearer ones counts as if they were so far apart.
constexpr double kShortestArm = 0.7;

}  // namespace

SharpBends::SharpBends(const SurfaceCells& cells, const NeighbourIndex<3>& neighbours, const Context& context)
    : cells_(cells), near_(static_cast<std::size_t>(cells.num_cells()), 0) {
  const double h = cells.grid().size();
  const double gentle = std::cos(kSharp * kShortestArm);
  const auto is_sharp = [&](Index i, const std::vector<Index>& around) {
    return std::ranges::any_of(around, [&](Index j) {
      if (cells.normals(i).col(0).dot(cells.normals(j).col(0)) >= gentle) return false;
      const double apart = (cells.point(i) - cells.point(j)).norm() / h;
      const double turn = normal_turn(cells, i, j);
      return apart > kNearest && apart < kFarthest && turn > kSharp * std::max(apart, kShortestArm) && turn < kMostTurn;
    });
  };
  std::vector<std::uint8_t> sharp(near_.size(), 0);
  constexpr Index kBlock = 512;
  parallel_for(context, 0, cells.num_cells(), kBlock, [&](Index first, Index last) {
    std::vector<Index> around;
    for (Index i = first; i < last; ++i) {
      if (!cells.valid(i)) continue;
      neighbours.around(i, around);
      sharp[static_cast<std::size_t>(i)] = is_sharp(i, around) ? 1 : 0;
    }
  });
  std::vector<Index> around;
  for (Index i = 0; i < cells.num_cells(); ++i) {
    if (sharp[static_cast<std::size_t>(i)] == 0) continue;
    neighbours.around(i, around);
    for (const Index j : around) near_[static_cast<std::size_t>(j)] = 1;
  }
}

bool SharpBends::along(const PointsIn& curve) const {
  std::vector<std::int32_t> cell(3);
  std::vector<std::int32_t> last;
  for (Index m = 0; m < curve.cols(); ++m) {
    cells_.grid().cell_of(curve.col(m), cell);
    if (cell == last) continue;
    last = cell;
    const Index i = cells_.grid().find(cell);
    if (i != CellGrid::kNone && near_[static_cast<std::size_t>(i)] != 0) return true;
  }
  return false;
}

}  // namespace taut::detail
