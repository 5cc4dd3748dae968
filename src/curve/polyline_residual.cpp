// A polyline judged as it is: how far its sides are off the surface, |J^+ F| at kPartsPerSide places each, and the
// discrete geodesic curvature at its corners by the vector triangle of the paper's Figure 2, the part tangent to the
// surface. O(m) evaluations in three visits.
#include "curve/polyline_residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/linear_algebra.hpp"
#include "curve/polyline.hpp"
#include "march/point_normals.hpp"

namespace taut::detail {
namespace {

constexpr Index kPartsPerSide = 8;

/// Largest |J^+ F| at the points (d x n).
double largest_distance(const Surface& surface, const Points& x) {
  const Points value = surface.value(x);
  const Points jacobian = surface.jacobian(x);
  double most = 0;
  for (Index j = 0; j < x.cols(); ++j) {
    const Eigen::Map<const Eigen::MatrixXd> gradients(jacobian.col(j).data(), surface.dim(), surface.codim());
    if (!gradients.allFinite() || !value.col(j).allFinite()) return std::numeric_limits<double>::quiet_NaN();
    const double distance = surface.codim() == 1 ? std::abs(value(0, j)) / gradients.norm()
                                                 : detail::least_squares(gradients.transpose(), value.col(j)).norm();
    most = std::max(most, distance);
  }
  return most;
}

}  // namespace

CurveResidual polyline_residual(const Surface& surface, const PointsIn& nodes) {
  CurveResidual residual;
  const Points corners = without_repeats(nodes);
  const Index sides = corners.cols() - 1;
  if (sides < 1) return residual;
  Points along(corners.rows(), sides * kPartsPerSide + 1);
  for (Index i = 0; i < sides; ++i) {
    for (Index part = 0; part < kPartsPerSide; ++part) {
      const double t = static_cast<double>(part) / kPartsPerSide;
      along.col(i * kPartsPerSide + part) = (1 - t) * corners.col(i) + t * corners.col(i + 1);
    }
  }
  along.rightCols(1) = corners.rightCols(1);
  residual.surface = largest_distance(surface, along);
  const Points normals = normals_at(surface, corners);
  for (Index i = 1; i < sides; ++i) {
    const Vector before = corners.col(i) - corners.col(i - 1);
    const Vector after = corners.col(i + 1) - corners.col(i);
    Vector bend = 2 * (after.normalized() - before.normalized()) / (before.norm() + after.norm());
    const Eigen::Map<const Eigen::MatrixXd> basis(normals.col(i).data(), surface.dim(), surface.codim());
    if (!basis.allFinite()) continue;  // no tangent space at a singular point
    bend -= basis * (basis.transpose() * bend);
    residual.geodesic_curvature = std::max(residual.geodesic_curvature, bend.norm());
  }
  return residual;
}

}  // namespace taut::detail
