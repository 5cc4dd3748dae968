#pragma once

#include <numbers>

#include "taut/core/types.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::paper {

/// A sheet rolled up along the spiral r = t about the y axis, one and a half turns that stand 2 pi apart: the roll of
/// the paper's Figure 3, and the "swiss roll" of manifold learning. Unrolled it is the flat strip of arc length
/// s(t) = (t sqrt(1 + t^2) + asinh t) / 2 and height, so its distances are those of the plane.
struct RolledSheet {
  static constexpr double kInnerAngle = 1.5 * std::numbers::pi;
  static constexpr double kOuterAngle = 4.5 * std::numbers::pi;

  double height = 8;

  static double arc_length(double t);
  static double angle_at(double s);  ///< the inverse
  static Eigen::Vector3d point(double t, double y);
  static Eigen::Vector3d normal(double t);  ///< unit, away from the axis

  /// Exact distance on the sheet between (t, y) and (t, y).
  static double distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

  /// n samples with normals, evenly along the strip with heights by the golden ratio. `places`, when not null, becomes
  /// 2 x n: (t, y) of each.
  [[nodiscard]] PointCloud cloud(Index n, Points* places = nullptr) const;
};

}  // namespace taut::paper
