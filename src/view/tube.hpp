#pragma once

#include "view/stage.hpp"

namespace taut::detail {

/// A round tube about a polyline, closed by round caps: what a thick path is drawn as.
struct Tube {
  Eigen::Matrix3Xf positions;
  Eigen::Matrix3Xf normals;
  Eigen::Matrix3Xi faces;
};
Tube make_tube(const Eigen::Matrix3Xf& polyline, float radius);

/// A ball, for end points.
Tube make_ball(const Eigen::Vector3f& centre, float radius);

}  // namespace taut::detail
