#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// Equation (5) of the paper for a batch: minimise |F(p)| subject to (p - p') . a = 0, by Newton's method in the plane
/// (Lagrange's condition grad F = mu a holds where it stops short of the surface). For k > 1 the pseudo-inverse of the
/// Jacobian restricted to the plane is used, so that every equation counts in units of length. `points`: d x n, p' on
/// entry, p on return. `axes`: d x n, unit vectors a; a zero column leaves that point free (the ordinary Newton-Raphson
/// projection). `radius`: n, no point moves farther from its p'. `tolerance`: model units. Returns where a point on the
/// surface was found; elsewhere the point of smallest residual is returned.
Eigen::Array<bool, Eigen::Dynamic, 1> project_in_planes(Evaluator& evaluator, Index dim, Index codim,
                                                        Eigen::Ref<Points> points, const PointsIn& axes,
                                                        const VectorIn& radius, double tolerance);

}  // namespace taut::detail
