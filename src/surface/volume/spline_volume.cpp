#include "surface/volume/spline_volume.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace taut::detail {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
/// Beyond it a box is bounded by blocks of coefficients; up to it, by the coefficients themselves. Cells along an axis.
constexpr Index kMostScanned = 8;
/// Up to so many cells, and two an axis, each is bounded by its own Bezier coefficients.
constexpr Index kMostPieces = 8;
/// By how much of their range the spline may leave the range of the coefficients in the overhang: there the outermost
/// weight is kOverhang^3 / 6 below zero on each axis.
constexpr double kOverhangRange =
    2 * 3 * SplineVolume::kOverhang * SplineVolume::kOverhang * SplineVolume::kOverhang / 6;

/// The four Bezier coefficients, on [a, b], of the piece with B-spline coefficients c_{-1} .. c_2 on [0, 1], as a
/// matrix: row r is the blossom at (a, a, a), (a, a, b), (a, b, b), (b, b, b). De Boor's algorithm with a different
/// parameter at each level (Ramshaw 1989).
Eigen::Matrix4d bezier_matrix(double a, double b) {
  Eigen::Matrix4d rows;
  for (int r = 0; r < 4; ++r) {
    const double t1 = r > 2 ? b : a;
    const double t2 = r > 1 ? b : a;
    const double t3 = r > 0 ? b : a;
    const Eigen::Matrix4d c = Eigen::Matrix4d::Identity();
    const Eigen::RowVector4d d0 = ((1 - t1) * c.row(0) + (t1 + 2) * c.row(1)) / 3;
    const Eigen::RowVector4d d1 = ((2 - t1) * c.row(1) + (t1 + 1) * c.row(2)) / 3;
    const Eigen::RowVector4d d2 = ((3 - t1) * c.row(2) + t1 * c.row(3)) / 3;
    const Eigen::RowVector4d e0 = ((1 - t2) * d0 + (t2 + 1) * d1) / 2;
    const Eigen::RowVector4d e1 = ((2 - t2) * d1 + t2 * d2) / 2;
    rows.row(r) = (1 - t3) * e0 + t3 * e1;
  }
  return rows;
}

}  // namespace

SplineVolume::SplineVolume(Lattice coefficients, const Eigen::Vector3d& origin, const Eigen::Matrix3d& axes,
                           const Context& context)
    : coefficients_(std::move(coefficients)),
      origin_(origin),
      axes_(axes),
      to_voxels_(axes.inverse()),
      pyramid_(coefficients_, context) {}

VoxelBox SplineVolume::voxel_box(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) const {
  const Eigen::Vector3d middle = to_voxels_ * (0.5 * (lower + upper) - origin_);
  const Eigen::Matrix3d size = to_voxels_.cwiseAbs();
  // Rounding of x - origin and of the products, here and where the spline is evaluated.
  const Eigen::Vector3d largest = lower.cwiseAbs().cwiseMax(upper.cwiseAbs()) + origin_.cwiseAbs();
  const Eigen::Vector3d reach = size * (0.5 * (upper - lower) + 16 * kEps * largest);
  return {(middle - reach).array(), (middle + reach).array()};
}

VoxelBox SplineVolume::world_box(const VoxelBox& box) const {
  const Eigen::Vector3d middle = origin_ + axes_ * (0.5 * (box.lower + box.upper)).matrix();
  const Eigen::Vector3d reach = axes_.cwiseAbs() * (0.5 * (box.upper - box.lower)).matrix();
  return {(middle - reach).array(), (middle + reach).array()};
}

ValueRange SplineVolume::bounds(const VoxelBox& box) const {
  std::array<Index, 3> first;
  std::array<Index, 3> last;
  VoxelBox inside;
  Index num_pieces = 1;
  Index most = 0;
  for (int a = 0; a < 3; ++a) {
    const auto end = static_cast<double>(num_cells(a));
    inside.lower(a) = std::clamp(box.lower(a), -kOverhang, end + kOverhang);
    inside.upper(a) = std::clamp(box.upper(a), -kOverhang, end + kOverhang);
    const auto axis = static_cast<std::size_t>(a);
    first[axis] = static_cast<Index>(std::clamp(std::floor(inside.lower(a)), 0.0, end - 1));
    last[axis] = static_cast<Index>(std::clamp(std::floor(inside.upper(a)), 0.0, end - 1));
    num_pieces *= last[axis] - first[axis] + 1;
    most = std::max(most, last[axis] - first[axis] + 1);
  }
  ValueRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  if (num_pieces <= kMostPieces && most <= 2) {
    for (Index k = first[2]; k <= last[2]; ++k) {
      for (Index j = first[1]; j <= last[1]; ++j) {
        for (Index i = first[0]; i <= last[0]; ++i) {
          const ValueRange piece = bezier_bounds({i, j, k}, inside);
          range.lower = std::min(range.lower, piece.lower);
          range.upper = std::max(range.upper, piece.upper);
        }
      }
    }
    return range;
  }
  float least = std::numeric_limits<float>::infinity();
  float largest = -least;
  if (most <= kMostScanned) {
    for (Index k = first[2]; k <= last[2] + 3; ++k) {
      for (Index j = first[1]; j <= last[1] + 3; ++j) {
        const float* row = coefficients_.values.data() + coefficients_.at(0, j, k);
        for (Index i = first[0]; i <= last[0] + 3; ++i) {
          least = std::min(least, row[i]);
          largest = std::max(largest, row[i]);
        }
      }
    }
  } else {
    const std::array<float, 2> found = pyramid_.range(first, last);
    least = found[0];
    largest = found[1];
  }
  const double slack = kOverhangRange * (static_cast<double>(largest) - static_cast<double>(least)) +
                       64 * kEps * std::max(std::abs(least), std::abs(largest));
  return {least - slack, largest + slack};
}

ValueRange SplineVolume::bezier_bounds(const std::array<Index, 3>& cell, const VoxelBox& box) const {
  std::array<Eigen::Matrix4d, 3> matrix;
  for (int a = 0; a < 3; ++a) {
    const Index index = cell[static_cast<std::size_t>(a)];
    const auto at = static_cast<double>(index);
    const double begin = index == 0 ? -kOverhang : 0;
    const double end = index == num_cells(a) - 1 ? 1 + kOverhang : 1;
    matrix[static_cast<std::size_t>(a)] =
        bezier_matrix(std::clamp(box.lower(a) - at, begin, end), std::clamp(box.upper(a) - at, begin, end));
  }
  // Along i, then j, then k. Column j of plane k is a row of coefficients.
  double largest = 0;
  Eigen::Matrix<double, 4, 16> along_i;
  for (Index k = 0; k < 4; ++k) {
    for (Index j = 0; j < 4; ++j) {
      const float* row = coefficients_.values.data() + coefficients_.at(cell[0], cell[1] + j, cell[2] + k);
      const Eigen::Vector4d c = Eigen::Map<const Eigen::Vector4f>(row).cast<double>();
      largest = std::max(largest, c.lpNorm<Eigen::Infinity>());
      along_i.col(4 * k + j) = matrix[0] * c;
    }
  }
  Eigen::Matrix<double, 16, 4> along_j;
  for (Index k = 0; k < 4; ++k) {
    Eigen::Map<Eigen::Matrix4d>(along_j.col(k).data()) = along_i.middleCols<4>(4 * k) * matrix[1].transpose();
  }
  const Eigen::Matrix<double, 16, 4> net = along_j * matrix[2].transpose();
  const double slack = 64 * kEps * largest;
  return {net.minCoeff() - slack, net.maxCoeff() + slack};
}

}  // namespace taut::detail
