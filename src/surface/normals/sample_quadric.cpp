#include "surface/normals/sample_quadric.hpp"

#include <Eigen/Cholesky>

#include "core/linear_algebra.hpp"

namespace taut::detail {

Axes axes_by_spread(const PointsIn& around) {
  const Direction mean = around.rowwise().mean();
  const Around centred = around.colwise() - mean;
  const Axes moment = centred.lazyProduct(centred.transpose());
  if (around.rows() == 2) return symmetric_eigen(Eigen::Matrix2d(moment)).vectors;
  return symmetric_eigen(Eigen::Matrix3d(moment)).vectors;
}

TermVector quadric_terms(const VectorIn& place) {
  const Index m = place.size();
  TermVector terms(num_quadric_terms(m));
  Index row = 0;
  terms(row++) = 1;
  for (Index a = 0; a < m; ++a) terms(row++) = place(a);
  for (Index a = 0; a < m; ++a) {
    for (Index b = 0; b <= a; ++b) terms(row++) = place(a) * place(b);
  }
  return terms;
}

TermVector fit_terms(const PointsIn& terms, const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostTerms, kMostTerms>;
  Square equations = terms.lazyProduct(terms.transpose());
  equations.diagonal().array() += kRidge * static_cast<double>(terms.cols());
  const TermVector right = terms.lazyProduct(values.transpose());
  return Eigen::LDLT<Square>(equations).solve(right);
}

}  // namespace taut::detail
