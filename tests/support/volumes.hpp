#pragma once

#include <Eigen/Core>
#include <random>

#include "taut/surface/volume.hpp"

namespace taut::test {

/// f at the voxels of an n x n x n volume that spans [-half, half]^3.
template <class F>
VoxelVolume sampled_volume(Index n, double half, const F& f) {
  VoxelVolume volume;
  volume.size = {n, n, n};
  volume.axes = 2 * half / static_cast<double>(n - 1) * Eigen::Matrix3d::Identity();
  volume.origin.setConstant(-half);
  for (Index k = 0; k < n; ++k) {
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i) {
        const Eigen::Vector3d voxel(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        volume.values.push_back(static_cast<float>(f(volume.origin + volume.axes * voxel)));
      }
    }
  }
  return volume;
}

/// Values without any pattern in [-1, 1], on a lattice that is neither straight nor even.
inline VoxelVolume noise_volume(Index nx, Index ny, Index nz) {
  VoxelVolume volume;
  volume.size = {nx, ny, nz};
  volume.axes << 0.9, 0.2, -0.1, -0.3, 1.1, 0.4, 0.2, -0.1, 1.7;
  volume.origin << 10, -20, 5;
  std::mt19937 random(7);
  for (Index v = 0; v < volume.num_voxels(); ++v) {
    volume.values.push_back(static_cast<float>(random()) * 0x1p-31F - 1.0F);
  }
  return volume;
}

}  // namespace taut::test
