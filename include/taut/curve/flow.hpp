#pragma once

#include "taut/core/context.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// How equation (4) is stepped through time. Both come to rest on the same curve.
enum class FlowTimeStep {
  linearly_implicit,  ///< a few dozen steps at any spacing (default)
  explicit_euler,     ///< Delta t = Delta h^2 / 4, as in the paper: the number of steps grows with 1 / spacing^2
};

struct FlowOptions {
  /// eps_E of the paper: a node is inserted where an interval is longer; model units. 0 = chosen such that (A1)
  /// predicts a length error below 2e-5 of the length.
  double spacing = 0;
  /// Size of the grid cells the start came from, model units: a gap within one cell is closed by (5). 0 = no grid, (5)
  /// is used only where the ordinary projection of a new node falls back onto its neighbours.
  double cell = 0;
  /// Balance parameter of (4), > 0: how fast nodes are drawn to the surface, in units of 1 / Delta h^2, so that it
  /// means the same whatever the scale of F and of the model. At most 4 with explicit steps.
  double beta = 1;
  /// Stop when the discrete |k_g| is below it at every node, 1 / model units. 0 = 1e-6 / length; where the noise of F
  /// forbids that, the least it allows, at most 1e-4 / length (a relative length error of some 1e-8).
  double curvature_bound = 0;
  int max_steps = 1000000;
  FlowTimeStep time_step = FlowTimeStep::linearly_implicit;
};

/// The corrected polyline: `points` are its nodes, `length` is the sum of its intervals (second order in the spacing,
/// from below), `length_error` bounds what is missing, `residual.surface` is measured at the nodes and half-way
/// between.
struct FlowResult : Geodesic {
  /// Error model of the paper's Appendix II in its sum form: sum_i r_i acos(1 - eps_i^2 / (2 r_i^2)) - eps_i with the
  /// radius of the osculating circle at each interval; an estimate of true length minus polyline length, model units.
  double model_error = 0;
  double model_error_uniform = 0;  ///< its closed form (A1) for one eps_i / r_i = cst; model units
  double cst = 0;                  ///< Cst of (A1): root mean square of eps_i / r_i, dimensionless
  double spacing = 0;              ///< longest interval between nodes, model units; at most the spacing asked for
  Index num_inserted = 0;          ///< nodes added because an interval was too long
  Index num_plane_inserted = 0;    ///< of those, by the plane-constrained projection (5)
};

/// The paper's geodesic correction (sec. 4): pulls `start` (d x m, m >= 2, near the surface) taut over the surface by
/// the curvature flow (2)-(3) in its particle form (4), adds nodes until no interval exceeds `spacing`, and stops when
/// the discrete geodesic curvature vanishes. The ends stay exactly where they are; when they coincide the answer is
/// that point. Throws InvalidArgument for a wrong shape, a non-finite coordinate or an option out of range, OutOfMemory
/// when the spacing asks for more nodes than memory holds, Cancelled. Everything else is told by `status`.
[[nodiscard]] FlowResult correct_flow(const Surface& surface, const PointsIn& start, const FlowOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
