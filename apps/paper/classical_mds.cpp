#include "classical_mds.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace taut::paper {

Embedding classical_mds(const Eigen::MatrixXd& distances, Index dim) {
  const Index n = distances.rows();
  const Eigen::MatrixXd squares = distances.cwiseAbs2();
  const Vector means = squares.rowwise().mean();
  // -1/2 J D^2 J with J = I - 1 1^T / n: the inner products of the centred points.
  Eigen::MatrixXd inner = squares;
  inner.colwise() -= means;
  inner.rowwise() -= means.transpose();
  inner = -0.5 * (inner.array() + means.mean()).matrix();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inner);

  Embedding embedding{.points = Points(dim, n), .eigenvalues = solver.eigenvalues().reverse()};
  for (Index k = 0; k < dim; ++k) {
    const double scale = std::sqrt(std::max(embedding.eigenvalues(k), 0.0));
    embedding.points.row(k) = scale * solver.eigenvectors().col(n - 1 - k).transpose();
  }
  double missed = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const double miss = distances(i, j) - (embedding.points.col(i) - embedding.points.col(j)).norm();
      missed += miss * miss;
    }
  }
  embedding.stress = std::sqrt(missed / squares.sum());
  return embedding;
}

Alignment align(const PointsIn& points, const PointsIn& target) {
  const Vector from = points.rowwise().mean();
  const Vector to = target.rowwise().mean();
  const Eigen::MatrixXd covariance = (target.colwise() - to) * (points.colwise() - from).transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::MatrixXd turn = svd.matrixU() * svd.matrixV().transpose();
  Alignment alignment;
  alignment.points = (turn * (points.colwise() - from)).colwise() + to;
  alignment.rms = std::sqrt((alignment.points - target).squaredNorm() / static_cast<double>(points.cols()));
  return alignment;
}

}  // namespace taut::paper
