#pragma once

// A sheet rolled up along the spiral r = t, one and a half turns that stand 2 pi apart (Figure 3 of the paper).
// Unrolled it is a flat strip, and so is each face of a thick one: distances are those of the plane.

#include <cmath>
#include <numbers>

#include "support/clouds.hpp"

namespace taut::test {

struct RolledSheet {
  static constexpr double kInnerAngle = 1.5 * std::numbers::pi;
  static constexpr double kOuterAngle = 4.5 * std::numbers::pi;
  static constexpr double kHeight = 8;

  /// Distance between its two faces; 0 = a sheet without thickness, whose samples all lie on the spiral.
  double thickness = 0;

  /// Arc length of the spiral r = t from its centre.
  static double arc_length(double t) { return 0.5 * (t * std::sqrt(1 + t * t) + std::asinh(t)); }
  /// The inverse, by Newton's method.
  static double angle_at(double s) {
    double t = std::sqrt(2 * s);
    for (int step = 0; step < 20; ++step) t -= (arc_length(t) - s) / std::sqrt(1 + t * t);
    return t;
  }
  /// Unit normal, away from the axis.
  static Eigen::Vector3d normal(double t) {
    return Eigen::Vector3d(t * std::cos(t) + std::sin(t), 0, t * std::sin(t) - std::cos(t)).normalized();
  }
  /// Where the sheet's mid-surface passes, moved by `out` along the normal.
  static Eigen::Vector3d point(double t, double height, double out = 0) {
    return Eigen::Vector3d(t * std::cos(t), height, t * std::sin(t)) + out * normal(t);
  }
  /// Length of the spiral moved by `out` along its normal between two angles: that changes by `out` times the turning
  /// of its tangent, whose angle is t + atan t.
  static double length(double from, double to, double out = 0) {
    return arc_length(to) - arc_length(from) + out * (to + std::atan(to) - from - std::atan(from));
  }

  /// `n` samples with outward normals, evenly along the strip with heights by the golden ratio, the two faces in turn;
  /// each stands off its place by a normal deviate of `noise` along the normal.
  [[nodiscard]] PointCloud cloud(Index n, double noise = 0) const {
    PointCloud cloud = empty_cloud(3, n);
    Uniform uniform(5);
    for (Index i = 0; i < n; ++i) {
      const double face = thickness == 0 || i % 2 == 0 ? 1 : -1;
      const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      const double t = angle_at(arc_length(kInnerAngle) + u * length(kInnerAngle, kOuterAngle));
      const double height = kHeight * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
      const double deviate = noise == 0 ? 0 : noise * uniform.normal();
      cloud.points.col(i) = point(t, height, face * thickness / 2 + deviate);
      cloud.normals.col(i) = face * normal(t);
    }
    return cloud;
  }
};

/// Two places on the roll by angle and height.
struct RollPair {
  double from_angle, from_height, to_angle, to_height;

  [[nodiscard]] double distance(double out = 0) const {
    return std::hypot(RolledSheet::length(from_angle, to_angle, out), to_height - from_height);
  }
};

/// Face to face on neighbouring turns, 6.3 apart through the air; over all turns; on one turn.
inline constexpr RollPair kRollPairs[] = {{2 * std::numbers::pi, 4, 4 * std::numbers::pi, 4},
                                          {1.6 * std::numbers::pi, 1.6, 4.3 * std::numbers::pi, 6.4},
                                          {3 * std::numbers::pi, 2.4, 3.2 * std::numbers::pi, 4.8}};

}  // namespace taut::test
