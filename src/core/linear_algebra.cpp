#include "core/linear_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace taut::detail {
namespace {

template <class Matrix>
SymmetricEigen<Matrix> decompose(const Matrix& a) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

SymmetricEigen<Eigen::Matrix2d> symmetric_eigen(const Eigen::Matrix2d& a) { return decompose(a); }
SymmetricEigen<Eigen::Matrix3d> symmetric_eigen(const Eigen::Matrix3d& a) { return decompose(a); }
SymmetricEigen<Eigen::MatrixXd> symmetric_eigen(const Eigen::MatrixXd& a) { return decompose(a); }

Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Vector symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::MatrixXd solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a.partialPivLu().solve(b); }

Eigen::MatrixXd orthogonal_complement(const PointsIn& columns) {
  const Index d = columns.rows();
  const Index m = columns.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  Eigen::MatrixXd last = Eigen::MatrixXd::Zero(d, d - m);
  last.bottomRows(d - m).setIdentity();
  return qr.householderQ() * last;
}

ThinQr thin_qr(const PointsIn& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return {qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols()),
          qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>()};
}

Eigen::MatrixXd span_basis(const PointsIn& columns) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

Vector least_squares(const PointsIn& a, const VectorIn& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  if (threshold > 0) solver.setThreshold(threshold);
  solver.compute(a);
  return solver.solve(b);
}

double determinant(const Eigen::MatrixXd& a) { return a.determinant(); }

Vector singular_values(const Eigen::MatrixXd& a) { return Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues(); }

}  // namespace taut::detail
