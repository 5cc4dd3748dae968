#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/cells/find_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/query/path.hpp"
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

struct SummaryOptions {
  double cell = 0;  ///< grid cell size h, model units; 0 = chosen
  GridMethod grid = GridMethod::automatic;
  Index envelope = 0;  ///< as PathOptions::envelope
  Points seeds = {};   ///< d x n: where Algorithm II begins on a surface that brings no samples (grid = grow)
};

/// The shape of a surface in space, from a mesh on the summary's cells, or on cells of a half, a quarter ... of their
/// size until two sizes tell the same. Features that are thinner than a cell are not in it.
struct SurfaceShape {
  double area = 0;      ///< of the triangles, model units squared; off by the order of h^2
  Index euler = 0;      ///< Euler characteristic V - E + F: 2 a closed body, less 2 a handle, less 1 a hole
  bool closed = false;  ///< no triangle has an edge of its own
  /// Open, though neither a domain nor a box of the user's ends it: the surface goes on beyond the box.
  bool cut_by_box = false;
  double cell = 0;  ///< h of the cells it was counted on, model units
  /// Cells of twice that size told the same Euler number. False where they told another and finer ones would be too
  /// many, and where one size was asked for (SummaryOptions::cell).
  bool settled = false;
};

/// What a surface is, before asking it anything.
struct SurfaceSummary {
  std::string kind;  ///< "formula", "rbf", "callback"
  Index dim = 0;
  Index codim = 0;
  // In more than 6 dimensions there are no cells, and these stay empty, but for those that Algorithm II grows from
  // samples (grid = grow): up to some number, at which counts.complete is false and components are not known.
  Box box;                                  ///< the cells' box: where the surface was found
  double cell = 0;                          ///< h, model units
  Index num_cells = 0;                      ///< that the surface may cross
  GridMethod grid = GridMethod::automatic;  ///< how they were found
  CellCounts counts;                        ///< the work that took
  Index num_layers = 0;                     ///< of the envelope around them, where one was asked for ...
  Index num_envelope_cells = 0;             ///< ... and all its cells
  std::vector<Index> components;            ///< cells of each connected component, largest first
  std::optional<SurfaceShape> shape;        ///< where d = 3 and k = 1
  std::optional<SurfaceEdges> edges;        ///< within the box; where there are any (see `surface_edges`)
  Index num_samples = 0;
  double sample_rms = 0;  ///< of |F| / |grad F| over the samples, model units
  double sample_max = 0;
};

/// Looks at the surface on its cells. Throws EmptySurface, OutOfMemory, Cancelled; InvalidArgument for options that do
/// not fit; SingularPoint, naming the equations, where they depend on each other all over the surface.
[[nodiscard]] SurfaceSummary summarise(const Surface& surface, const SummaryOptions& options = {},
                                       const Context& context = {});

}  // namespace taut
