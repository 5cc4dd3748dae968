#pragma once

#include "taut/core/types.hpp"
#include "taut/curve/flow.hpp"
#include "taut/march/march.hpp"

namespace taut {

/// What shortens the marched polyline.
enum class CorrectionMethod {
  newton,  ///< Newton's method on a spectral curve: machine precision
  flow,    ///< the paper's curvature flow: second order in the node spacing
  grid,    ///< nothing: the marched path as it is on the cells (see `descend`), the paper's before its correction
};

/// How the cells around the surface are found.
enum class GridMethod {
  automatic,  ///< grow for surfaces fitted to samples, subdivide for the others
  subdivide,  ///< Algorithm I: every cell the surface crosses
  grow,       ///< Algorithm II: from the samples or, on a surface without, from the two ends and PathOptions::seeds
};

/// PathOptions::envelope: as many layers as the error bound wants (`envelope_layers`).
inline constexpr Index kEnvelopeByLaw = -1;

struct PathOptions {
  CorrectionMethod method = CorrectionMethod::newton;
  MarchMethod march = MarchMethod::convergent;
  GridMethod grid = GridMethod::automatic;
  /// Grid cell size h, model units. 0 = chosen, and halved by itself where the cells cannot tell two sheets apart.
  double cell = 0;
  /// d x n: points on or near a surface without samples from which Algorithm II grows, too (grid = grow).
  Points seeds = {};
  /// Layers of cells added on either side of those that the surface crosses (`thicken`), for the marches between cell
  /// centres: axis and dijkstra. 0 = the bare cells; kEnvelopeByLaw.
  Index envelope = 0;
  /// Relative length tolerance, 1e-13 .. 1e-3.
  double tolerance = 1e-9;
  /// eps_E, the node spacing of the flow, model units; 0 = chosen.
  double spacing = 0;
  /// beta of the flow's equation (4), at most 4 with explicit steps.
  double beta = 1;
  FlowTimeStep flow_step = FlowTimeStep::linearly_implicit;
  NodeSpread flow_nodes = NodeSpread::even;
  /// Look for every way round, however long, not only for rivals of the shortest.
  bool all = false;
  /// Fill PathResult::walked_cells. Then every path is marched for itself, by no table.
  bool keep_cells = false;
};

}  // namespace taut
