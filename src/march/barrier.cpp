// Where a march stopped: a reached cell next to a valid cell that was not reached, although their points are
// neighbours. u(y) + |y - x| is a lower bound of the ways to x past such a cell y; the least tells which one matters. A
// cell costs a block of 3^d look-ups, if it can still be the least.
#include "march/barrier.hpp"

#include <cmath>
#include <limits>

#include "cells/normal_turn.hpp"
#include "march/stencil.hpp"

namespace taut::detail {
std::optional<Barrier> find_barrier(const SurfaceCells& cells, const DistanceField& field, const VectorIn& x) {
  if (field.at_centres) return std::nullopt;  // it passes wherever cells share a face
  detail::Stencil stencil(cells.dim());
  const auto reached = [&](Index i) { return i < field.distance.size() && std::isfinite(field.distance(i)); };
  double least = std::numeric_limits<double>::infinity();
  std::optional<Barrier> barrier;
  for (Index i = 0; i < field.distance.size(); ++i) {
    if (!reached(i)) continue;
    const double length = field.distance(i) + (cells.point(i) - x).norm();
    if (length >= least) continue;
    // One unreached neighbour is enough: of the place beyond, only the turn of the normals is told.
    for (const Index j : stencil.block(cells.grid(), cells.grid().cell(i))) {
      if (!cells.valid(j) || reached(j)) continue;
      least = length;
      barrier = {cells.point(i), detail::normal_turn(cells, i, j)};
      break;
    }
  }
  return barrier;
}

}  // namespace taut::detail
