#include "ignored_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace taut::app {
namespace {

constexpr Index kMostFaces = 4000;    // looked at: a fraction of the time of a fit
constexpr double kNoteworthy = 0.01;  // of the path's length

}  // namespace

double distance_off_faces(const Surface& surface) {
  const PointCloud* samples = surface.samples();
  if (samples == nullptr || samples->faces.cols() == 0 || surface.codim() != 1) return 0;
  const Index stride = (samples->faces.cols() + kMostFaces - 1) / kMostFaces;
  Points middles(3, (samples->faces.cols() + stride - 1) / stride);
  for (Index j = 0; j < middles.cols(); ++j) {
    const Eigen::Vector3i face = samples->faces.col(j * stride);
    middles.col(j) = (samples->points.col(face(0)) + samples->points.col(face(1)) + samples->points.col(face(2))) / 3;
  }
  const Points value = surface.value(middles);
  const Points gradient = surface.jacobian(middles);
  double farthest = 0;
  for (Index j = 0; j < middles.cols(); ++j) {
    const double distance = std::abs(value(0, j)) / gradient.col(j).norm();
    if (std::isfinite(distance)) farthest = std::max(farthest, distance);
  }
  return farthest;
}

void tell_of_ignored_faces(const Surface& surface, double length, const Context& context) {
  if (!(length > 0)) return;
  const double off = distance_off_faces(surface);
  if (off <= kNoteworthy * length) return;
  context.tell(fmt::format(
      "the path runs over a smooth surface fitted through the mesh's {} vertices, which stands up to {:.3g} off "
      "its faces ({:.2g} % of the length): the faces are ignored; a mesh with more vertices is followed closer",
      surface.samples()->size(), off, 100 * off / length));
}

}  // namespace taut::app
