#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "march/cell_steps.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

/// The cell that a march between centres starts from for a source x (d): the one that holds it or, where that is not
/// present, the nearest centre of those that touch it. kNone when there is none.
[[nodiscard]] inline Index start_cell(const CellGrid& grid, const VectorIn& x) {
  const Index own = grid.find_point(x);
  if (own != CellGrid::kNone) return own;
  std::vector<std::int32_t> cell(static_cast<std::size_t>(x.size()));
  grid.cell_of(x, cell);
  const auto over = grid.dim() > CellSteps::kMostDiagonalDim ? CellSteps::Over::faces : CellSteps::Over::corners;
  Index nearest = CellGrid::kNone;
  double least = std::numeric_limits<double>::infinity();
  CellSteps steps(grid, over);
  for (const Index i : steps.around(cell)) {
    const double distance = (grid.centre(i) - x).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

/// The same; throws InvalidArgument when there is none.
[[nodiscard]] inline Index checked_start_cell(const CellGrid& grid, const VectorIn& source) {
  const Index start = start_cell(grid, source);
  if (start == CellGrid::kNone) throw InvalidArgument("no cell lies around the source " + describe(source));
  return start;
}

/// Reads a field of distances between cell centres (DistanceField::at_centres), finished or still growing.
class CentreReader {
 public:
  CentreReader(const CellGrid& grid, const DistanceField& field)
      : grid_(grid),
        field_(field),
        steps_(grid, field.method == MarchMethod::axis ? CellSteps::Over::faces : CellSteps::Over::corners),
        cell_(static_cast<std::size_t>(grid.dim())) {
    for (Index s = 0; s < field.sources.cols(); ++s) starts_.push_back(start_cell(grid, field.sources.col(s)));
  }

  /// The reached cell around x (d) over whose centre the way to x is the shortest, and its length: straight from there.
  /// (kNone, infinity) where there is none.
  [[nodiscard]] std::pair<Index, double> last_cell(const VectorIn& x) {
    std::pair<Index, double> best{CellGrid::kNone, std::numeric_limits<double>::infinity()};
    grid_.cell_of(x, cell_);
    for (const Index i : steps_.around(cell_)) {
      if (!is_reached(i)) continue;
      const double length = field_.distance(i) + (grid_.centre(i) - x).norm();
      if (length < best.second) best = {i, length};
    }
    return best;
  }

  /// The distance at x: straight from a source in the same cell, else of the way by `last_cell`; infinity where there
  /// is none.
  [[nodiscard]] double distance(const VectorIn& x) {
    const std::pair<Index, double> last = last_cell(x);
    double distance = last.second;
    for (std::size_t s = 0; s < starts_.size(); ++s) {
      if (starts_[s] == last.first)
        distance = std::min(distance, (x - field_.sources.col(static_cast<Index>(s))).norm());
    }
    return distance;
  }

  /// Which source starts in cell i, -1: none.
  [[nodiscard]] Index source_in(Index i) const {
    const auto at = std::ranges::find(starts_, i);
    return at == starts_.end() ? -1 : at - starts_.begin();
  }

  /// The cell that a way down goes to from cell i: over which the march has come (Dijkstra), or the one in whose
  /// direction the distance falls fastest. kNone where there is none below.
  [[nodiscard]] Index next_cell(Index i) {
    const double here = field_.distance(i);
    double most = -std::numeric_limits<double>::infinity();
    Index next = CellGrid::kNone;
    for (const Index j : steps_.around(grid_.cell(i))) {
      if (!is_reached(j) || !(field_.distance(j) < here)) continue;
      const double step = (grid_.centre(i) - grid_.centre(j)).norm();
      const double fall = here - field_.distance(j);
      // Dijkstra: no neighbour falls by more than its step, and only those the walk can have come over by all of it.
      // Axis: the steepest neighbour.
      const double merit = field_.method == MarchMethod::dijkstra ? fall - step : fall / step;
      if (merit <= most) continue;
      most = merit;
      next = j;
    }
    return next;
  }

 private:
  [[nodiscard]] bool is_reached(Index i) const {
    return i < field_.distance.size() && field_.distance(i) < std::numeric_limits<double>::infinity();
  }

  const CellGrid& grid_;
  const DistanceField& field_;
  CellSteps steps_;
  std::vector<std::int32_t> cell_;
  std::vector<Index> starts_;  // by source: its cell
};

}  // namespace taut::detail
