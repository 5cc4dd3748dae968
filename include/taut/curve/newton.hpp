#pragma once

#include "taut/core/context.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct NewtonOptions {
  double tolerance = 1e-9;  ///< relative length tolerance, 1e-13 .. 1e-3
  int max_iterations = 200;
  int max_elements = 4096;
};

/// Shortens `start` (d x m, m >= 2, near the surface) with its ends fixed to a geodesic by Newton's method on a
/// spectral element curve: piecewise polynomials of degree p on Gauss-Lobatto-Legendre nodes, F = 0 at the nodes,
/// adaptive in element size and p until `tolerance` is met.
[[nodiscard]] Geodesic correct_newton(const Surface& surface, const PointsIn& start, const NewtonOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
