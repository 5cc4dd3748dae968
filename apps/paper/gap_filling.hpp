#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::paper {

/// How a new node between two others is brought onto the surface.
enum class NodeProjection {
  ordinary,  ///< Newton-Raphson from the middle of the gap (sec. 4): to a nearby surface point
  in_plane,  ///< equation (5): within the plane through the middle of the gap and across it
};

struct GapFilling {
  Points nodes;                 ///< d x m: a, the nodes put in, b
  std::vector<double> longest;  ///< longest interval, to start with and after each node
};

/// Puts `num_nodes` nodes between a and b, one at a time, each into the interval that is longest by then: what the
/// paper's insertion does, without the flow in between. A node that cannot be projected stays where it is.
[[nodiscard]] GapFilling fill_gap(const Surface& surface, const VectorIn& a, const VectorIn& b, Index num_nodes,
                                  NodeProjection projection);

}  // namespace taut::paper
