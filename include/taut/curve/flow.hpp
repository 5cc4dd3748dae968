#pragma once

#include "taut/core/context.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct FlowOptions {
  double spacing = 0;  ///< eps_E of the paper: insert a node where an interval is longer; model units; 0 = chosen
  double cell = 0;     ///< grid cell size: a gap within one cell is closed by (5); 0 = no grid
  double beta = 1;     ///< balance parameter of (4)
  double curvature_bound =
      0;  ///< stop when the discrete |k_g| is below it, 1 / model units; 0 = chosen from the spacing
  int max_steps = 1000000;
};

struct FlowResult : Geodesic {
  double model_error = 0;        ///< (A1): estimate of true length minus polyline length, model units
  Index num_inserted = 0;        ///< nodes added because an interval exceeded `spacing`
  Index num_plane_inserted = 0;  ///< of those, by the plane-constrained projection (5)
};

/// The paper's geodesic correction: curvature flow (2)-(3), particle equation (4), insertion, (5). Second order in the
/// spacing.
[[nodiscard]] FlowResult correct_flow(const Surface& surface, const PointsIn& start, const FlowOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
