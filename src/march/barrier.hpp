#pragma once

#include <optional>

#include "taut/march/march.hpp"

namespace taut::detail {

/// Where a march stopped although there are cells beyond.
struct Barrier {
  Vector point;  ///< d: the last surface point reached
  double turn;   ///< by how much the normal space turns from there to the cell beyond, radians, at most pi
};

/// Of all places where the field stopped between neighbouring cells because no edge on one smooth sheet joins them, the
/// one on the shortest way past it to x. Empty when it stopped nowhere. A turn near 0 or pi tells of two sheets closer
/// than a cell, any other of a crease or a singular point. Codimension 1 tells 0 from pi; above it the turn is at most
/// pi / 2.
[[nodiscard]] std::optional<Barrier> find_barrier(const SurfaceCells& cells, const DistanceField& field,
                                                  const VectorIn& x);

}  // namespace taut::detail
