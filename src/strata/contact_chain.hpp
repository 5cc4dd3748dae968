#pragma once

#include <vector>

#include "strata/bordered_surface.hpp"
#include "strata/facet_chain.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/newton.hpp"

namespace taut::detail {

/// An arc of a path that touches borders: a geodesic of the surface, or of a border that it follows.
struct ContactArc {
  int border = BorderedSurface::kFree;
  Points start;  ///< d x m: to begin from; its ends need not be exact
  NewtonResult geodesic = {};
};

/// A shortest path of a surface with borders, in any dimension: arcs of the surface and of borders by turns, which meet
/// where the path touches a border.
struct ContactChain {
  Points contacts;  ///< d x (n - 1), contact i between arcs i and i + 1
  std::vector<ContactArc> arcs;
  bool solved = false;
  ChainFault fault = ChainFault::none;  ///< why it is not solved
  Vector place;                         ///< and where
  double length = 0;
  double error = 0;
  /// Directions in which the length falls when contacts are moved along the border across the path, and within arcs.
  int index = 0;
  bool locally_shortest = false;  ///< and it rises in all others
  int steps = 0;
};

/// The shortest path near `start` (d x m, from p to q, both on the surface and inside; it may run through what is
/// forbidden) among those that stay inside. Borders must be smooth and must not meet along it.
[[nodiscard]] ContactChain shorten_inside(BorderedSurface& surface, const Points& start, const Context& context);

}  // namespace taut::detail
