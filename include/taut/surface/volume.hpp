#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Numbers on a lattice in space, as a scanner or a simulation gives them. The centre of voxel (i, j, k) lies at
/// origin + axes (i, j, k), in world coordinates.
struct VoxelVolume {
  std::array<Index, 3> size = {0, 0, 0};               ///< voxels along i, j, k
  std::vector<float> values;                           ///< one a voxel, i runs fastest, k slowest
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< the centre of voxel (0, 0, 0)
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< column a: the step to the next voxel along axis a

  [[nodiscard]] Index num_voxels() const { return size[0] * size[1] * size[2]; }
};

/// What in a volume is the surface: give `iso` or `label`.
struct VolumeOptions {
  /// The surface is where the interpolated value is this.
  std::optional<double> iso = std::nullopt;
  /// For segmentations: the surface bounds the voxels that have exactly this value. Their indicator (1 in them, 0
  /// elsewhere) is smoothed, and the surface is where it is 1/2: what is thinner than about the smoothing is lost.
  std::optional<double> label = std::nullopt;
  /// Standard deviation of the Gaussian the voxels are smoothed with first, in voxels along each axis. Unset = 0 for
  /// `iso`, 1 for `label`, which takes no less than 0.5: the staircase of the voxels would stay.
  std::optional<double> smooth = std::nullopt;
};

/// The level set of a volume: the C^2 tricubic B-spline that passes through the voxels' values (Unser, Aldroubi and
/// Eden 1991), with not-a-knot ends, so of fourth order in the voxel size up to the border. F < 0 inside; the outside
/// is the side of `iso` on which most voxels of the volume's faces lie (for `label`: what has another label). Where
/// the surface reaches a face of the volume it ends there, at the centres of the last voxels: a domain, told to
/// `context.note`. Coefficients are kept as 32-bit floats: they, not the values, define F exactly. Its value,
/// derivatives and bounds take O(1) a point or box, and memory is 4.3 bytes a voxel and what `volume` holds while it is
/// built. Parallel; threads do not change it.
///
/// Throws InvalidArgument for fewer than 4 voxels along an axis, values that are not finite, a lattice whose axes are
/// zero or lie in a plane, and unless one of `iso` and `label` is given (the message then says how the values are
/// distributed). Throws EmptySurface, with the range of the values, when `iso` is never met or nothing has `label`.
[[nodiscard]] Surface volume_surface(VoxelVolume volume, const VolumeOptions& options, const Context& context = {});

}  // namespace taut
