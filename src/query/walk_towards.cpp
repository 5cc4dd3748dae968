#include "query/walk_towards.hpp"

#include <Eigen/Cholesky>
#include <vector>

#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

constexpr int kStepsPerChord = 48;
constexpr int kMostSteps = 20 * kStepsPerChord;
/// A step that brings q nearer by less than this part of its length is no progress.
constexpr double kLeastProgress = 0.02;

/// q - x without its part normal to the surface at x.
Vector tangent_part(const Surface& surface, const Vector& x, const Vector& r) {
  const Points jacobian = surface.jacobian(x);
  const Eigen::Map<const Eigen::MatrixXd> normals(jacobian.data(), surface.dim(), surface.codim());
  // Least squares by the normal equations: J is well conditioned wherever the projection just succeeded.
  const Eigen::MatrixXd gram = normals.transpose() * normals;
  return r - normals * gram.ldlt().solve(normals.transpose() * r);
}

}  // namespace

Points walk_towards(const Surface& surface, const VectorIn& p, const VectorIn& q) {
  const double step = (q - p).norm() / kStepsPerChord;
  std::vector<Vector> line = {p};
  for (int i = 0; i < kMostSteps; ++i) {
    const Vector& x = line.back();
    const Vector r = q - x;
    const double left = r.norm();
    if (left <= 1.5 * step) {
      line.emplace_back(q);
      Points path(p.size(), static_cast<Index>(line.size()));
      for (std::size_t j = 0; j < line.size(); ++j) path.col(static_cast<Index>(j)) = line[j];
      return path;
    }
    const Vector t = tangent_part(surface, x, r);
    if (t.norm() < kLeastProgress * left) break;
    try {
      const ProjectionResult next =
          project_to_surface(surface, x + step * t.normalized(), ProjectionOptions{.max_distance = step});
      if (!next.converged || (q - next.point).norm() > left - kLeastProgress * step) break;
      line.push_back(next.point);
    } catch (const SingularPoint&) {
      break;
    }
  }
  return Points(p.size(), 0);
}

}  // namespace taut::detail
