#include "curves.hpp"

#include <algorithm>
#include <limits>

namespace taut::paper {
namespace {

double distance_to(const PointsIn& line, const VectorIn& x) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i + 1 < line.cols(); ++i) {
    const Vector edge = line.col(i + 1) - line.col(i);
    const double along = edge.squaredNorm() > 0 ? edge.dot(x - line.col(i)) / edge.squaredNorm() : 0;
    least = std::min(least, (line.col(i) + std::clamp(along, 0.0, 1.0) * edge - x).norm());
  }
  return least;
}

}  // namespace

double polyline_length(const PointsIn& line) {
  double length = 0;
  for (Index i = 0; i + 1 < line.cols(); ++i) length += (line.col(i + 1) - line.col(i)).norm();
  return length;
}

double distance_between(const PointsIn& a, const PointsIn& b) {
  double most = 0;
  for (const auto& x : a.colwise()) most = std::max(most, distance_to(b, x));
  for (const auto& x : b.colwise()) most = std::max(most, distance_to(a, x));
  return most;
}

Vector point_along(const PointsIn& line, double length) {
  for (Index i = 0; i + 1 < line.cols(); ++i) {
    const double edge = (line.col(i + 1) - line.col(i)).norm();
    if (length <= edge && edge > 0) return line.col(i) + length / edge * (line.col(i + 1) - line.col(i));
    length -= edge;
  }
  return line.rightCols(1);
}

}  // namespace taut::paper
