#pragma once

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// What the paper's Appendix II counts and estimates, of one curve that the curvature flow has corrected.
/// Notation there: m intervals eps_i between successive nodes, sum eps_i = L; r_i radius of the osculating circle.
struct FlowSummary {
  Index num_intervals = 0;      ///< m: the curve has m + 1 nodes, its two ends among them
  double length = 0;            ///< L, the polyline's length, model units
  double mean_interval = 0;     ///< mean of the eps_i, model units
  double longest_interval = 0;  ///< largest eps_i, model units; at most the eps_E asked for where the status is ok
  double cst = 0;               ///< Cst of (A1): root mean square of eps_i / r_i, dimensionless
  double error_a1 = 0;          ///< (A1), L (acos(1 - Cst^2 / 2) / Cst - 1): one Cst for the whole curve; model units
  /// The sum that (A1) simplifies: sum_i r_i acos(1 - eps_i^2 / (2 r_i^2)) - eps_i, model units. An estimate of the
  /// geodesic's length minus the polyline's.
  double error_sum = 0;
  Index num_inserted = 0;        ///< nodes put in by ordinary projection since an interval was longer than eps_E
  Index num_plane_inserted = 0;  ///< nodes put in by the plane-constrained projection (5), besides those
  Index num_across_cells = 0;    ///< of the latter: across a gap wider than one grid cell (docs/flow.md)
  int num_iterations = 0;        ///< time steps of (4) tried
  Index num_evaluated = 0;       ///< nodes at which F was evaluated: the work, the same on every machine
  double seconds = 0;            ///< wall-clock time of the whole correction
  double seconds_per_node = 0;   ///< K of (A2), measured: seconds / m
  /// (A2) with that K and err = error_sum, seconds. It is `seconds` times error_sum / error_a1: how far one Cst for the
  /// whole curve misjudges the nodes that the error takes.
  double seconds_a2 = 0;
};

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
