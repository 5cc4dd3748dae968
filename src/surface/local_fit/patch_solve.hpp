#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <vector>

#include "surface/local_fit/cubic.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// The samples that patches are fitted to: distinct points with unit normals, d x n.
struct OrientedSamples {
  const Points& points;
  const Points& normals;
};

/// Fits one patch after another; owns the memory for it, so each thread makes its own.
template <int D>
class PatchSolver {
 public:
  explicit PatchSolver(OrientedSamples samples) : samples_(samples) {}

  /// The cubic with the least sum over the samples `near` of
  ///   theta_j [ f(x_j)^2 / R^2 + kNormals |grad f(x_j) - n_j|^2 ],   theta = (1 - |x_j - c|^2 / R^2)^2,
  /// and a very small multiple of the squares of its coefficients of degree two and three: what the samples leave open
  /// (how F bends away from a flat sheet, say) is as straight as can be.
  [[nodiscard]] Patch<D> fit(const std::array<double, D>& centre, double radius, const std::vector<Neighbour>& near);

  /// For the fit just made: root mean square over the first `count` samples of how far each lies off the surface that
  /// is fitted without it, model units (leave-one-out cross-validation, by the block formula (I - G)^-1 e).
  [[nodiscard]] double left_out(Index count);

 private:
  static constexpr int kSize = static_cast<int>(Cubic<D>::kSize);
  static constexpr int kRows = D + 1;  // equations of a sample

  OrientedSamples samples_;
  Eigen::Matrix<double, kSize, Eigen::Dynamic> equations_;  // kRows columns a sample, weighted
  Eigen::Matrix<double, kRows, Eigen::Dynamic> wanted_;     // weighted
  std::vector<double> weight_;                              // of each sample: the root of theta
  Eigen::LLT<Eigen::Matrix<double, kSize, kSize>> factor_;
  Patch<D> patch_;
  bool solved_ = false;
};

}  // namespace taut::detail
