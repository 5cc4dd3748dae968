#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// One edge of a surface, from corner to corner or all around.
struct SurfaceEdge {
  enum class Kind : std::uint8_t {
    sharp,   ///< two faces meet at an angle
    seam,    ///< two faces meet smoothly, and only the curvature jumps
    border,  ///< the surface ends: at its domain, or at an obstacle
  };
  Kind kind = Kind::sharp;
  std::vector<std::string> faces;  ///< formulas: of the two that meet, of a border's one
  /// Model units, to rounding; to about 1e-6 of the surface's size where it ends in a point where its faces touch.
  double length = 0;
  double angle = 0;  ///< the largest between the faces' normals, radians; 0 of a border
  bool closed = false;
  bool cut = false;  ///< by the box: the edge goes on
  Points points;     ///< 3 x n, on the edge, in order; a closed one repeats its first
};
[[nodiscard]] const char* to_string(SurfaceEdge::Kind kind);

/// A smooth piece of a surface.
struct SurfaceFace {
  std::string formula;
  int patches = 1;  ///< pieces that hang together
};

/// What a surface is made of that is not smooth. Empty of a smooth one.
struct SurfaceEdges {
  std::vector<SurfaceFace> faces;
  std::vector<SurfaceEdge> edges;
  Points corners = Points(3, 0);  ///< 3 x m, where edges end
};

/// Follows all edges and borders within the box (empty: a box that holds the surface, see `find_box`). Strips and
/// pieces much thinner than 1/40 of the box may be missed. Surfaces that have none, or for which edges are not looked
/// for (other than one equation in R^3), give nothing. Throws EmptySurface, OutOfMemory, Cancelled.
[[nodiscard]] SurfaceEdges surface_edges(const Surface& surface, const Box& box = {}, const Context& context = {});

}  // namespace taut
