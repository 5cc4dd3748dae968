#include "rolled_sheet.hpp"

#include <cmath>
#include <numbers>

namespace taut::paper {

double RolledSheet::arc_length(double t) { return 0.5 * (t * std::sqrt(1 + t * t) + std::asinh(t)); }

double RolledSheet::angle_at(double s) {
  double t = std::sqrt(2 * s);
  constexpr int kSteps = 20;  // Newton's method; a handful suffice
  for (int step = 0; step < kSteps; ++step) t -= (arc_length(t) - s) / std::sqrt(1 + t * t);
  return t;
}

Eigen::Vector3d RolledSheet::point(double t, double y) { return {t * std::cos(t), y, t * std::sin(t)}; }

Eigen::Vector3d RolledSheet::normal(double t) {
  return Eigen::Vector3d(t * std::cos(t) + std::sin(t), 0, t * std::sin(t) - std::cos(t)).normalized();
}

double RolledSheet::distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::hypot(arc_length(b.x()) - arc_length(a.x()), b.y() - a.y());
}

PointCloud RolledSheet::cloud(Index n, Points* places) const {
  PointCloud cloud{.points = Points(3, n), .normals = Points(3, n), .faces = Eigen::Matrix3Xi(3, 0)};
  if (places != nullptr) places->resize(2, n);
  const double inner = arc_length(kInnerAngle);
  const double outer = arc_length(kOuterAngle);
  for (Index i = 0; i < n; ++i) {
    const double t = angle_at(inner + (static_cast<double>(i) + 0.5) / static_cast<double>(n) * (outer - inner));
    const double y = height * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
    cloud.points.col(i) = point(t, y);
    cloud.normals.col(i) = normal(t);
    if (places != nullptr) places->col(i) << t, y;
  }
  return cloud;
}

}  // namespace taut::paper
