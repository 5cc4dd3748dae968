#include "taut/surface/curvature.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

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
  const Index d = surface.dim();
  SurfaceCurvature result;
  result.point = projected.point;
  const Vector gradient = surface.jacobian(result.point);
  const double slope = gradient.norm();
  if (!(slope > 0)) throw SingularPoint("the surface has no tangent space at " + detail::describe(result.point));
  result.normal = gradient / slope;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(result.normal);
  const Eigen::MatrixXd tangents = Eigen::MatrixXd(qr.householderQ()).rightCols(d - 1);
  const Eigen::MatrixXd shape =
      tangents.transpose() * surface.hessian(result.point, Vector::Ones(1)) * tangents / slope;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(shape);
  result.principal = eigen.eigenvalues().reverse();
  result.directions = tangents * eigen.eigenvectors().rowwise().reverse();
  result.mean = result.principal.mean();
  result.gaussian = result.principal.prod();
  return result;
}

}  // namespace taut
