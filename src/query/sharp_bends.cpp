#include "query/sharp_bends.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cells/normal_turn.hpp"

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

bool bends_sharply(const SurfaceCells& cells, const NeighbourIndex<3>& neighbours, const PointsIn& curve) {
  const double h = cells.grid().size();
  // Where all normals are within half the least turn that counts of one of them, no two differ by as much.
  const double gentle = std::cos(0.5 * kSharp * kShortestArm);
  std::vector<std::int32_t> cell(3);
  std::vector<std::int32_t> last;
  std::vector<Index> around;
  for (Index m = 0; m < curve.cols(); ++m) {
    cells.grid().cell_of(curve.col(m), cell);
    if (cell == last) continue;
    last = cell;
    neighbours.around(cell.data(), around);
    const auto like_first = [&](Index i) {
      return cells.normals(i).col(0).dot(cells.normals(around[0]).col(0)) > gentle;
    };
    if (std::ranges::all_of(around, like_first)) continue;
    for (std::size_t a = 0; a < around.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double apart = (cells.point(around[a]) - cells.point(around[b])).norm() / h;
        if (apart < kNearest || apart > kFarthest) continue;
        const double turn = normal_turn(cells, around[a], around[b]);
        if (turn > kSharp * std::max(apart, kShortestArm) && turn < kMostTurn) return true;
      }
    }
  }
  return false;
}

}  // namespace taut::detail
