// Where a surface in space turns by more than kSharp radians over the size of a cell, seen by pairs of neighbouring
// cells' points: near enough to belong together, far enough apart to tell. Turns near pi are two sheets back to back.
// Cells around such a place count, too. At single points the normal itself is differenced, which sees needles thinner
// than a cell.
#include "search/sharp_bends.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "cells/normal_turn.hpp"
#include "core/parallel.hpp"
#include "march/point_normals.hpp"

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
/// At a point itself: radians a cell, by a finite difference over so many cells.
constexpr double kSharpAtPoint = 1;
constexpr double kStep = 1e-6;

}  // namespace

SharpBends::SharpBends(const Surface& surface, const SurfaceCells& cells, const NeighbourIndex<3>& neighbours,
                       const Context& context)
    : surface_(surface), cells_(cells), near_(static_cast<std::size_t>(cells.num_cells()), 0) {
  const double h = cells.grid().size();
  const double gentle = std::cos(kSharp * kShortestArm);
  const auto is_sharp = [&](Index i, const std::vector<Index>& around) {
    return std::ranges::any_of(around, [&](Index j) {
      // Most pairs end here, before any arc cosine.
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
    any_ = true;
    neighbours.around(i, around);
    for (const Index j : around) near_[static_cast<std::size_t>(j)] = 1;
  }
}

bool SharpBends::is_near(const VectorIn& x) const {
  std::array<std::int32_t, 3> cell;
  cells_.grid().cell_of(x, cell);
  const Index i = cells_.grid().find(cell);
  return i != CellGrid::kNone && near_[static_cast<std::size_t>(i)] != 0;
}

std::vector<std::uint8_t> SharpBends::at(const PointsIn& x) const {
  std::vector<std::uint8_t> sharp(static_cast<std::size_t>(x.cols()));
  const Points normals = normals_at(surface_, x);
  const double step = kStep * cells_.grid().size();
  Points beside(3, 2 * x.cols());  // each point moved to two sides
  for (Index j = 0; j < x.cols(); ++j) {
    const Eigen::Vector3d normal = normals.col(j);
    const Eigen::Vector3d side = normal.unitOrthogonal();
    beside.col(2 * j) = x.col(j) + step * side;
    beside.col(2 * j + 1) = x.col(j) + step * normal.cross(side);
  }
  const Points turned = normals_at(surface_, beside);
  for (Index j = 0; j < x.cols(); ++j) {
    const double turn = (turned.middleCols<2>(2 * j).colwise() - normals.col(j)).norm();
    const bool gentle = turn <= kSharpAtPoint * kStep;  // not where there is no normal
    sharp[static_cast<std::size_t>(j)] = !gentle || is_near(x.col(j)) ? 1 : 0;
  }
  return sharp;
}

bool SharpBends::along(const PointsIn& curve) const {
  const std::vector<std::uint8_t> sharp = at(curve);
  return std::ranges::any_of(sharp, [](std::uint8_t is_sharp) { return is_sharp != 0; });
}

}  // namespace taut::detail
