#pragma once

#include "taut/core/types.hpp"

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

}  // namespace taut
