#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>

#include "surface/volume/lattice.hpp"
#include "surface/volume/value_pyramid.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// A box in voxel coordinates: (i, j, k) at the centre of voxel (i, j, k).
struct VoxelBox {
  Eigen::Array3d lower;
  Eigen::Array3d upper;
};

struct ValueRange {
  double lower = 0;
  double upper = 0;
};

/// A tricubic B-spline on a lattice in space. Immutable. Along axis a it has `num_cells(a)` cells between the centres
/// of voxels; kOverhang beyond the outermost centres the outermost cubics go on (so that F is C^2 around the domain's
/// edge), and from there it stays as it is on that axis.
class SplineVolume {
 public:
  static constexpr double kOverhang = 1.0 / 16;

  /// `coefficients` as `prefilter` makes them, for voxels in space as in VoxelVolume.
  SplineVolume(Lattice coefficients, const Eigen::Vector3d& origin, const Eigen::Matrix3d& axes,
               const Context& context);

  [[nodiscard]] Index num_cells(int axis) const { return coefficients_.size[static_cast<std::size_t>(axis)] - 3; }
  [[nodiscard]] const Lattice& coefficients() const { return coefficients_; }
  /// From world to voxel coordinates: u = to_voxels (x - origin).
  [[nodiscard]] const Eigen::Matrix3d& to_voxels() const { return to_voxels_; }
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }

  /// The voxel box around a world box, rounding included.
  [[nodiscard]] VoxelBox voxel_box(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) const;
  /// The world box around a voxel box.
  [[nodiscard]] VoxelBox world_box(const VoxelBox& box) const;

  /// Bounds of the spline over a box. Within two cells an axis they come from the Bezier coefficients of the piece in
  /// the box, and overestimate by O(size^2); over more from the B-spline coefficients that matter there, or from the
  /// least and largest of blocks of them.
  [[nodiscard]] ValueRange bounds(const VoxelBox& box) const;

  /// The cells, as a voxel box, of all blocks in which the spline may vanish; false when there are none.
  [[nodiscard]] bool zero_box(VoxelBox& box) const { return pyramid_.zero_box(box.lower, box.upper); }

 private:
  [[nodiscard]] ValueRange bezier_bounds(const std::array<Index, 3>& cell, const VoxelBox& box) const;

  Lattice coefficients_;
  Eigen::Vector3d origin_;
  Eigen::Matrix3d axes_;
  Eigen::Matrix3d to_voxels_;
  ValuePyramid pyramid_;
};

}  // namespace taut::detail
