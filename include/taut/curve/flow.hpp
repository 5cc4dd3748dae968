#pragma once

#include "taut/core/context.hpp"
#include "taut/curve/flow_summary.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// How equation (4) is stepped through time. Both come to rest on the same curve.
enum class FlowTimeStep {
  linearly_implicit,  ///< a few dozen steps at any spacing (default)
  explicit_euler,     ///< Delta t = Delta h^2 / 4, as in the paper: the number of steps grows with 1 / spacing^2
};

/// How nodes are spread along the curve. The paper asks for both (docs/flow.md).
enum class NodeSpread {
  even,       ///< sec. 4: as evenly as bends sharper than eps_E allow, which take more of them (default)
  curvature,  ///< Appendix II: eps_i / r_i = Cst, r_i the radius of curvature
};

/// The cells that a start was walked on: cell c of Z^d covers origin + size * [c, c + 1].
struct FlowLattice {
  double size = 0;  ///< h, model units; 0 = no cells
  Vector origin;    ///< d, with size > 0
};

struct FlowOptions {
  /// eps_E of the paper: after every relaxation a node is inserted where an interval is longer, until none is; model
  /// units. 0 = chosen such that (A1) predicts a length error below 2e-5 of the length.
  double spacing = 0;
  NodeSpread nodes = NodeSpread::even;
  /// Where a gap falls in one of these cells and the projection of a new node falls back onto an end of it, (5) closes
  /// it. Without cells (5) is used wherever that projection falls back.
  FlowLattice lattice = {};
  /// Balance parameter of (4), > 0: how fast nodes are drawn to the surface, in units of 1 / Delta h^2, so that it
  /// means the same whatever the scale of F and of the model. An explicit step takes a node beta / 4 of the way, so
  /// it is at most 4 there. Implicit steps take beta / (beta + Delta h^2 / Delta t) of it, and Delta t grows: beta
  /// changes the way only.
  double beta = 1;
  FlowTimeStep time_step = FlowTimeStep::linearly_implicit;
  /// Stop when the discrete |k_g| is below it at every node, 1 / model units. 0 = 1e-6 / length; where the noise of F
  /// forbids that, the least it allows, at most 1e-4 / length (a relative length error of some 1e-8).
  double curvature_bound = 0;
  /// Nodes at which F may be evaluated before the best curve so far is returned as not_converged. 0 = chosen: 2e6 for
  /// implicit steps, 2e9 / d for explicit ones.
  Index max_evaluated = 0;
};

/// The corrected polyline: `points` are its nodes, `length` is the sum of its intervals (second order in the spacing,
/// from below), `length_error` bounds what is missing, `residual.surface` is measured at the nodes and half-way
/// between.
struct FlowResult : Geodesic {
  FlowSummary summary;
};

/// The paper's geodesic correction (sec. 4): pulls `start` (d x m, m >= 2, near the surface) taut over the surface by
/// the curvature flow (2)-(3) in its particle form (4), adds nodes until no interval exceeds `spacing`, and stops when
/// the discrete geodesic curvature vanishes. The ends stay exactly where they are; when they coincide the answer is
/// that point. Throws InvalidArgument for a wrong shape, a non-finite coordinate or an option out of range, OutOfMemory
/// when the spacing asks for more nodes than memory holds, Cancelled. Everything else is told by `status`, also that
/// the work allowed is used up.
[[nodiscard]] FlowResult correct_flow(const Surface& surface, const PointsIn& start, const FlowOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
