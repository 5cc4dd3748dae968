// Orthonormal bases of normal spaces by Gram and Schmidt on the gradients of the k equations, column by column. A
// gradient that keeps less than kRankTolerance of its length depends on those before it: the point is singular, its
// basis NaN.
#include "march/point_normals.hpp"

#include <limits>

namespace taut::detail {

Points normals_at(const Surface& surface, const PointsIn& x) {
  const Index d = surface.dim();
  Points bases = surface.jacobian(x);
  for (Index j = 0; j < bases.cols(); ++j) {
    Eigen::Map<Eigen::MatrixXd> basis(bases.col(j).data(), d, surface.codim());
    bool regular = basis.allFinite();
    for (Index c = 0; regular && c < basis.cols(); ++c) {
      const double before = basis.col(c).norm();
      for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Kahan)
        for (Index b = 0; b < c; ++b) basis.col(c) -= basis.col(b).dot(basis.col(c)) * basis.col(b);
      }
      const double after = basis.col(c).norm();
      constexpr double kRankTolerance = 1e-10;
      regular = after > kRankTolerance * before;
      basis.col(c) /= after;
    }
    if (!regular) basis.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return bases;
}

}  // namespace taut::detail
