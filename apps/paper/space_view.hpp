#pragma once

#include <numbers>

#include <Eigen/Geometry>

#include "drawing.hpp"

namespace taut::paper {

/// Draws space on paper: parallel projection, seen from an azimuth and an elevation (degrees), z upwards.
class SpaceView {
 public:
  SpaceView(double azimuth, double elevation, double scale, Eigen::Vector2d origin) : scale_(scale), origin_(origin) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double a = azimuth * kDegree;
    const double e = elevation * kDegree;
    towards_viewer_ = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    right_ = Eigen::Vector3d::UnitZ().cross(towards_viewer_).normalized();
    up_ = towards_viewer_.cross(right_);
  }

  [[nodiscard]] Eigen::Vector2d see(const Eigen::Vector3d& x) const {
    return origin_ + scale_ * Eigen::Vector2d(right_.dot(x), -up_.dot(x));
  }
  /// 3 x n as 2 x n.
  [[nodiscard]] Points see_all(const Points& points) const {
    Points seen(2, points.cols());
    for (Index i = 0; i < points.cols(); ++i) seen.col(i) = see(points.col(i));
    return seen;
  }
  /// Larger is nearer to the viewer.
  [[nodiscard]] double nearness(const Eigen::Vector3d& x) const { return towards_viewer_.dot(x); }
  [[nodiscard]] const Eigen::Vector3d& towards_viewer() const { return towards_viewer_; }

 private:
  double scale_;
  Eigen::Vector2d origin_;
  Eigen::Vector3d towards_viewer_, right_, up_;
};

}  // namespace taut::paper
