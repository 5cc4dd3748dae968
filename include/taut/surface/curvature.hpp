#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// How a surface of one equation bends at a point.
struct SurfaceCurvature {
  Vector point;         ///< d: on the surface
  Vector normal;        ///< d: unit, along grad F (outwards)
  Vector principal;     ///< d - 1: principal curvatures, 1 / model units, largest first; those of a sphere are positive
  Points directions;    ///< d x (d - 1): unit tangents that belong to them; any frame where curvatures are equal
  double mean = 0;      ///< mean of the principal curvatures: div n / (d - 1)
  double gaussian = 0;  ///< their product; on surfaces in R^3 Gaussian curvature
};

/// At x (d), projected onto the surface first: eigenvalues of the shape operator P H P / |grad F| on the tangent space.
/// Exact to rounding where F is. Throws InvalidArgument for more than one equation, a wrong dimension and points that
/// are not finite or from which no surface point is found; SingularPoint where grad F vanishes.
[[nodiscard]] SurfaceCurvature curvature_at(const Surface& surface, const VectorIn& x);

}  // namespace taut
