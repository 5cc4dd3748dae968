#pragma once

#include <optional>

#include "taut/core/context.hpp"
#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// How far a curve is from being a geodesic of the surface.
struct CurveResidual {
  double surface = 0;             ///< max |F| / |grad F| along the curve, between nodes too, model units
  double geodesic_curvature = 0;  ///< sup |k_g| along the curve, 1 / model units
};

/// A corrected curve.
struct Geodesic {
  Status status = Status::not_converged;
  double length = 0;         ///< model units
  double length_error = 0;   ///< honest estimate of |length - true length of this geodesic|, model units
  bool locally_shortest = false;  ///< by certificate: no conjugate point inside
  std::optional<double> conjugate_at;  ///< arc length from the start of the first conjugate point, when one is inside
  CurveResidual residual;
  int num_iterations = 0;
  Points points;             ///< d x m nodes in order, first and last exactly the end points given
};

struct NewtonOptions {
  double tolerance = 1e-9;   ///< relative length tolerance, 1e-13 .. 1e-3
  int max_iterations = 200;
  int max_elements = 4096;
};

/// Shortens `start` (d x m, m >= 2, near the surface) with its ends fixed to a geodesic by Newton's method on a spectral
/// element curve: piecewise polynomials of degree p on Gauss-Lobatto-Legendre nodes, F = 0 at the nodes, adaptive
/// in element size and p until `tolerance` is met.
[[nodiscard]] Geodesic correct_newton(const Surface& surface, const PointsIn& start, const NewtonOptions& options = {},
                                      const Context& context = {});

struct FlowOptions {
  double spacing = 0;        ///< eps_E of the paper: insert a node where an interval is longer; model units; 0 = chosen
  double cell = 0;           ///< grid cell size: a gap within one cell is closed by (5); 0 = no grid
  double beta = 1;           ///< balance parameter of (4)
  double curvature_bound = 0;  ///< stop when the discrete |k_g| is below it, 1 / model units; 0 = chosen from the spacing
  int max_steps = 1000000;
};

struct FlowResult : Geodesic {
  double model_error = 0;    ///< (A1): estimate of true length minus polyline length, model units
  Index num_inserted = 0;    ///< nodes added because an interval exceeded `spacing`
  Index num_plane_inserted = 0;  ///< of those, by the plane-constrained projection (5)
};

/// The paper's geodesic correction: curvature flow (2)-(3), particle equation (4), insertion, (5). Second order in the spacing.
[[nodiscard]] FlowResult correct_flow(const Surface& surface, const PointsIn& start, const FlowOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
