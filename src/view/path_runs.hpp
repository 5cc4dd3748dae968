#pragma once

#include <vector>

#include "view/raster.hpp"

namespace taut::detail {

/// A stretch of a path on the picture, all of it seen or all of it hidden.
struct PathRun {
  bool hidden = false;
  std::vector<Eigen::Vector2d> pixels;  ///< at least two; a run begins where the one before ends
};

/// Cuts a path where it goes behind the meshes. Stretches of a few pixels are no runs of their own.
std::vector<PathRun> cut_path(const Eigen::Matrix3Xf& path, const Camera& camera, const DepthImage& depth, double lift);

}  // namespace taut::detail
