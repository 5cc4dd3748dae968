#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::paper {

/// A flat strip bent about the y axis without stretching: at arc length s its tangent turns to `wave` sin(2 pi s / L) +
/// `roll` s / L radians. All poses are isometric: distances are those of the flat strip.
struct BentSheet {
  double length = 6;  ///< L
  double width = 3;   ///< along y
  double wave = 0;
  double roll = 0;

  [[nodiscard]] Eigen::Vector3d point(double s, double y) const;
  [[nodiscard]] Eigen::Vector3d normal(double s) const;
  /// About n samples with normals on a lattice of the strip, every second row moved by half a step.
  [[nodiscard]] PointCloud cloud(Index n) const;
};

}  // namespace taut::paper
