#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// A bicubic B-spline over the plane, C^2, in grid coordinates: sample (i, j) stands at (i, j), 0 <= i < columns,
/// 0 <= j < rows. Outside of the samples the outermost cubics go on. Immutable.
class PlaneSpline {
 public:
  /// With these coefficients, (columns + 2) x (rows + 2), the first index running fastest: the outermost ones stand one
  /// pixel outside of the samples.
  PlaneSpline(Index columns, Index rows, std::vector<double> coefficients);
  /// The one that passes through `values`, columns x rows, both at least 4.
  [[nodiscard]] static PlaneSpline through(Index columns, Index rows, const std::vector<double>& values);

  [[nodiscard]] Index columns() const { return columns_; }
  [[nodiscard]] Index rows() const { return rows_; }

  struct Jet {
    double value = 0;
    double u = 0;  // derivatives
    double v = 0;
    double uu = 0;
    double uv = 0;
    double vv = 0;
  };
  [[nodiscard]] Jet at(double u, double v) const;

  struct Range {
    double lower = 0;
    double upper = 0;
  };
  /// Bounds over [u0, u1] x [v0, v1]; unbounded where that reaches out of the samples by more than kOverhang.
  [[nodiscard]] Range range(double u0, double u1, double v0, double v1) const;
  static constexpr double kOverhang = 1.0 / 16;

 private:
  [[nodiscard]] double coefficient(Index i, Index j) const {
    return coefficients_[static_cast<std::size_t>(i + (columns_ + 2) * j)];
  }
  /// Of the piece between samples i and i + 1, j and j + 1, over a part of it (or a little beyond).
  [[nodiscard]] Range piece_range(Index i, Index j, const std::array<double, 4>& part) const;

  /// Least and greatest coefficient of blocks of 2^level coefficients a side.
  struct Level {
    Index columns = 0;
    Index rows = 0;
    std::vector<Range> blocks;
  };
  [[nodiscard]] Range coefficient_range(Index i0, Index i1, Index j0, Index j1) const;

  Index columns_;
  Index rows_;
  std::vector<double> coefficients_;
  std::vector<Level> levels_;  // the first of blocks of 2 x 2
  double largest_ = 0;         // magnitude of a coefficient
};

}  // namespace taut::detail
