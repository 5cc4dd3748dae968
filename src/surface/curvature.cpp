#include "taut/surface/curvature.hpp"

#include "core/linear_algebra.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {

SurfaceCurvature curvature_at(const Surface& surface, const VectorIn& x) {
  if (surface.codim() != 1) throw InvalidArgument("curvatures are told of surfaces of one equation");
  const ProjectionResult projected = project_to_surface(surface, x);
  if (!projected.converged) {
    throw InvalidArgument("no point of the surface was found near " + detail::describe(x) + "; give one closer");
  }
  SurfaceCurvature result;
  result.point = projected.point;
  const Vector gradient = surface.jacobian(result.point);
  const double slope = gradient.norm();
  if (!(slope > 0)) throw SingularPoint("the surface has no tangent space at " + detail::describe(result.point));
  result.normal = gradient / slope;
  const Eigen::MatrixXd tangents = detail::orthogonal_complement(result.normal);
  const Eigen::MatrixXd shape =
      tangents.transpose() * surface.hessian(result.point, Vector::Ones(1)) * tangents / slope;
  const auto eigen = detail::symmetric_eigen(shape);
  result.principal = eigen.values.reverse();
  result.directions = tangents * eigen.vectors.rowwise().reverse();
  result.mean = result.principal.mean();
  result.gaussian = result.principal.prod();
  return result;
}

}  // namespace taut
