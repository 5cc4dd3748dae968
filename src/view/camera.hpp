#pragma once

#include "view/stage.hpp"

namespace taut::detail {

/// A point as the camera sees it: in pixels (x right, y down, 0,0 the upper left corner), and how near it is. Nearness
/// is linear over the image of a plane, so a depth buffer may interpolate it; larger is nearer.
struct Seen {
  double x = 0;
  double y = 0;
  double nearness = 0;
};

/// Where the viewer stands. Perspective by default; parallel for flat scenes.
class Camera {
 public:
  /// Looks at the ball of `stage` against `towards_viewer`, with the stage's up direction upwards.
  Camera(const Stage& stage, const Eigen::Vector3d& towards_viewer);

  /// Scales and shifts the image so that all of `stage` just fits between margins of a picture, in pixels.
  void fit(const Stage& stage, double left, double top, double right, double bottom);

  [[nodiscard]] Seen see(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d p = axes_.transpose() * x;
    const double depth = distance_ - p.z();
    if (parallel_) return {shift_x_ + scale_ * p.x(), shift_y_ - scale_ * p.y(), p.z()};
    return {shift_x_ + scale_ * p.x() / depth * distance_, shift_y_ - scale_ * p.y() / depth * distance_, 1 / depth};
  }
  /// From a point to the viewer, unit.
  [[nodiscard]] Eigen::Vector3d towards_viewer(const Eigen::Vector3d& x) const {
    return parallel_ ? Eigen::Vector3d(axes_.col(2)) : Eigen::Vector3d((eye() - x).normalized());
  }
  [[nodiscard]] Eigen::Vector3d eye() const { return distance_ * axes_.col(2); }
  [[nodiscard]] bool parallel() const { return parallel_; }
  /// Columns: right, up, towards the viewer.
  [[nodiscard]] const Eigen::Matrix3d& axes() const { return axes_; }
  /// Pixels a model unit at the scene's middle.
  [[nodiscard]] double scale() const { return scale_; }

  /// The distance of the viewer from the scene's middle, in radii of the scene.
  static constexpr double kDistance = 4.2;

 private:
  Eigen::Matrix3d axes_;
  double distance_;
  bool parallel_;
  double scale_ = 1;
  double shift_x_ = 0;
  double shift_y_ = 0;
};

/// The direction from which most of the paths and points is seen, long, unhidden and from outside, and an open surface
/// from the side its normals face; with a slight liking for the usual view from a little above.
Eigen::Vector3d choose_view(const Stage& stage);

}  // namespace taut::detail
