#include "bent_sheet.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace taut::paper {

Eigen::Vector3d BentSheet::point(double s, double y) const {
  // The tangent integrated by Simpson's rule, far below what is measured here.
  constexpr int kSteps = 400;
  const auto tangent = [this](double at) {
    const double angle = wave * std::sin(2 * std::numbers::pi * at / length) + roll * at / length;
    return Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  Eigen::Vector2d place(0, 0);
  const double step = s / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    place += step / 6 * (tangent(i * step) + 4 * tangent((i + 0.5) * step) + tangent((i + 1) * step));
  }
  return {place.x(), y, place.y()};
}

Eigen::Vector3d BentSheet::normal(double s) const {
  const double angle = wave * std::sin(2 * std::numbers::pi * s / length) + roll * s / length;
  return {-std::sin(angle), 0, std::cos(angle)};
}

PointCloud BentSheet::cloud(Index n) const {
  const double step = std::sqrt(length * width / static_cast<double>(n));
  const auto columns = static_cast<Index>(length / step);
  const auto rows = static_cast<Index>(width / step);
  PointCloud cloud{.points = Points(3, (columns + 1) * (rows + 1)), .normals = {}, .faces = Eigen::Matrix3Xi(3, 0)};
  cloud.normals = cloud.points;
  Index count = 0;
  for (Index i = 0; i <= columns; ++i) {
    const double s = length * static_cast<double>(i) / static_cast<double>(columns);
    const Eigen::Vector3d start = point(s, 0);
    for (Index j = 0; j <= rows; ++j) {
      const double y = width * (static_cast<double>(j) + (i % 2 == 0 ? 0.25 : -0.25)) / static_cast<double>(rows);
      cloud.points.col(count) = start + Eigen::Vector3d(0, y, 0);
      cloud.normals.col(count++) = normal(s);
    }
  }
  return cloud;
}

}  // namespace taut::paper
