#include "surface/local_fit/patch_solve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::detail {
namespace {

/// Weight of a normal's error (radians) against a miss of one radius, squared. Measured on the vertices of ten scans
/// and meshes, a tenth held out: 0.01 and 1 leave misses 5 to 10 % larger; on clean torus samples there is no
/// difference.
constexpr double kNormals = 0.09;
/// Of the coefficients of degree two and three, against the sum of the weights. Ten times as much bends a clean torus
/// measurably; ten thousand times less changes nothing there.
constexpr double kStraightness = 1e-6;
/// Samples at the edge of the ball still count a little: so many as are needed are inside.
constexpr double kLeastWeight = 1e-3;

}  // namespace

template <int D>
Patch<D> PatchSolver<D>::fit(const std::array<double, D>& centre, double radius, const std::vector<Neighbour>& near) {
  const auto n = static_cast<Index>(near.size());
  equations_.resize(Eigen::NoChange, kRows * n);
  wanted_.resize(Eigen::NoChange, n);
  weight_.resize(near.size());
  const double normal_weight = std::sqrt(kNormals);
  double total = 0;
  for (Index j = 0; j < n; ++j) {
    const Neighbour& sample = near[static_cast<std::size_t>(j)];
    const double rest = std::max(1 - sample.squared_distance / (radius * radius), 0.0);
    const double theta = std::max(rest * rest, kLeastWeight);
    const double root = std::sqrt(theta);
    std::array<double, D> u{};
    for (int a = 0; a < D; ++a) {
      u[static_cast<std::size_t>(a)] =
          (samples_.points(a, sample.index) - centre[static_cast<std::size_t>(a)]) / radius;
    }
    auto block = equations_.middleCols(kRows * j, kRows);
    Cubic<D>::basis(u, block.data());
    block.col(0) *= root;
    wanted_(0, j) = 0;
    for (int a = 0; a < D; ++a) {
      block.col(1 + a) *= root * normal_weight;
      wanted_(1 + a, j) = root * normal_weight * samples_.normals(a, sample.index);
    }
    weight_[static_cast<std::size_t>(j)] = root;
    total += theta;
  }
  Eigen::Matrix<double, kSize, kSize> normal_equations = Eigen::Matrix<double, kSize, kSize>::Zero();
  normal_equations.template selfadjointView<Eigen::Lower>().rankUpdate(equations_);
  for (int i = static_cast<int>(Cubic<D>::kQuadratic); i < kSize; ++i) normal_equations(i, i) += kStraightness * total;
  const Eigen::Map<const Vector> wanted(wanted_.data(), wanted_.size());
  const Eigen::Matrix<double, kSize, 1> right = equations_ * wanted;
  factor_.compute(normal_equations);
  solved_ = factor_.info() == Eigen::Success;
  patch_.centre = centre;
  patch_.radius = radius;
  Eigen::Map<Eigen::Matrix<double, kSize, 1>> solution(patch_.cubic.coefficient.data());
  solution = factor_.solve(right);
  solved_ = solved_ && solution.allFinite();
  if (!solved_) {  // samples that say nothing, such as one point many times: a plane through the nearest
    solution.setZero();
    for (int a = 0; a < D; ++a) {
      solution(static_cast<int>(Cubic<D>::kLinear) + a) = samples_.normals(a, near.front().index);
    }
  }
  return patch_;
}

template <int D>
double PatchSolver<D>::left_out(Index count) {
  if (!solved_) return std::numeric_limits<double>::infinity();
  const Eigen::Map<const Eigen::Matrix<double, kSize, 1>> solution(patch_.cubic.coefficient.data());
  count = std::min(count, static_cast<Index>(weight_.size()));
  double sum = 0;
  for (Index j = 0; j < count; ++j) {
    const auto block = equations_.middleCols(kRows * j, kRows);
    const Eigen::Matrix<double, kSize, kRows> solved = factor_.solve(block);
    const Eigen::Matrix<double, kRows, kRows> rest =
        Eigen::Matrix<double, kRows, kRows>::Identity() - block.transpose() * solved;
    const Eigen::Matrix<double, kRows, 1> miss = wanted_.col(j) - block.transpose() * solution;
    const double without = rest.partialPivLu().solve(miss)(0) / weight_[static_cast<std::size_t>(j)];
    sum += without * without;
  }
  return patch_.radius * std::sqrt(sum / static_cast<double>(count));
}

template class PatchSolver<2>;
template class PatchSolver<3>;

}  // namespace taut::detail
