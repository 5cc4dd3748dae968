#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/cells/cell_counts.hpp"
#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_edges.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct SummaryOptions {
  double cell = 0;  ///< grid cell size h, model units; 0 = chosen
  GridMethod grid = GridMethod::automatic;
  Index envelope = 0;  ///< as PathOptions::envelope
  Points seeds = {};   ///< d x n: where Algorithm II begins on a surface that brings no samples (grid = grow)
};

/// The shape of a surface in space, from its display mesh on the summary's cells: the numbers of features that are
/// thinner than a cell are not in them.
struct SurfaceShape {
  double area = 0;      ///< of the triangles, model units squared; off by the order of h^2
  Index euler = 0;      ///< Euler characteristic V - E + F: 2 a closed body, less 2 a handle, less 1 a hole
  bool closed = false;  ///< no triangle has an edge of its own
  /// Open, though neither a domain nor a box of the user's ends it: the surface goes on beyond the box.
  bool cut_by_box = false;
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
