// Distances on triangles. The distances of two corners a and b of a triangle say where the source would lie in its
// plane, on the other side of ab, were all triangles on the way unfolded into it. The third corner's distance is the
// one from there, where the straight line passes between a and b; else the way leads over a corner. A vertex that comes
// nearer is worked off again, nearest first, so that obtuse triangles need no care.
#include "march/mesh_march.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace taut::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A source lies on all triangles that are no farther from it than the nearest one and this part of its longest side.
constexpr double kOnTriangle = 1e-3;
/// What counts as nearer.
constexpr double kNearer = 1 - 1e-12;

/// The distance of a point from a triangle.
double distance_to(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double twice = normal.squaredNorm();
  if (twice > 0) {
    const double u = (b - p).cross(c - p).dot(normal) / twice;
    const double v = (c - p).cross(a - p).dot(normal) / twice;
    if (u >= 0 && v >= 0 && u + v <= 1) return std::abs((p - a).dot(normal)) / std::sqrt(twice);
  }
  const auto to_side = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d side = to - from;
    const double size = side.squaredNorm();
    const double t = size > 0 ? std::clamp(side.dot(p - from) / size, 0.0, 1.0) : 0.0;
    return (from + t * side - p).norm();
  };
  return std::min({to_side(a, b), to_side(b, c), to_side(c, a)});
}

}  // namespace

MeshMarch::MeshMarch(const TriangleMesh& mesh)
    : mesh_(mesh),
      first_(static_cast<std::size_t>(mesh.vertices.cols()) + 1, 0),
      around_(static_cast<std::size_t>(3 * mesh.faces.cols())),
      distance_(Vector::Constant(mesh.vertices.cols(), kInfinity)),
      source_(static_cast<std::size_t>(mesh.vertices.cols()), -1) {
  for (const int v : mesh.faces.reshaped()) ++first_[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    for (const int v : mesh.faces.col(f)) around_[next[static_cast<std::size_t>(v)]++] = f;
  }
}

/// The distance of c by way of the side from a to b, infinite where the straight line passes beside it.
double MeshMarch::over(int a, int b, int c) const {
  const Eigen::Vector3d side = mesh_.vertices.col(b) - mesh_.vertices.col(a);
  const Eigen::Vector3d to = mesh_.vertices.col(c) - mesh_.vertices.col(a);
  const double l = side.norm();
  if (!(l > 0)) return kInfinity;
  // In the plane of the triangle: a = (0, 0), b = (l, 0), c = (cx, cy), and the source seen below ab at (sx, -sy).
  const double cx = to.dot(side) / l;
  const double cy = to.cross(side).norm() / l;
  const double sx = (distance_(a) * distance_(a) - distance_(b) * distance_(b) + l * l) / (2 * l);
  const double below = distance_(a) * distance_(a) - sx * sx;
  // The two distances and the side form no triangle: they came round different ways.
  if (!(below >= 0)) return kInfinity;
  const double sy = std::sqrt(below);
  if (!(sy + cy > 0)) return kInfinity;
  const double crossing = sx + (cx - sx) * sy / (sy + cy);
  if (crossing < 0 || crossing > l) return kInfinity;
  return std::hypot(cx - sx, cy + sy);
}

void MeshMarch::add_source(const VectorIn& x, const Context& context) {
  const std::int32_t number = num_sources_++;
  using Entry = std::tuple<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](int v, double distance) {
    if (!(distance < kNearer * distance_(v))) return;
    distance_(v) = distance;
    source_[static_cast<std::size_t>(v)] = number;
    open.emplace(distance, v);
  };
  // Every triangle is looked at once a source: O(faces), less than the march.
  const Eigen::Vector3d p = x;
  Vector away(mesh_.faces.cols());
  Index nearest = 0;
  for (Index f = 0; f < mesh_.faces.cols(); ++f) {
    away(f) = distance_to(p, mesh_.vertices.col(mesh_.faces(0, f)), mesh_.vertices.col(mesh_.faces(1, f)),
                          mesh_.vertices.col(mesh_.faces(2, f)));
    if (away(f) < away(nearest)) nearest = f;
  }
  double longest = 0;
  for (Index i = 0; i < 3; ++i) {
    longest = std::max(
        longest,
        (mesh_.vertices.col(mesh_.faces((i + 1) % 3, nearest)) - mesh_.vertices.col(mesh_.faces(i, nearest))).norm());
  }
  for (Index f = 0; f < mesh_.faces.cols(); ++f) {
    if (away(f) > away(nearest) + kOnTriangle * longest) continue;
    for (const int v : mesh_.faces.col(f)) reach(v, (mesh_.vertices.col(v) - x).norm());
  }
  for (std::size_t count = 0; !open.empty(); ++count) {
    if (count % 4096 == 0) context.check_cancelled();
    const auto [distance, v] = open.top();
    open.pop();
    // An older entry of a vertex that came nearer since.
    if (distance > distance_(v)) continue;
    const auto i = static_cast<std::size_t>(v);
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
      const auto face = mesh_.faces.col(around_[k]);
      const int at = face(0) == v ? 0 : face(1) == v ? 1 : 2;
      const int b = face((at + 1) % 3);
      const int c = face((at + 2) % 3);
      for (const auto& [known, wanted] : {std::pair(b, c), std::pair(c, b)}) {
        double found = distance + (mesh_.vertices.col(wanted) - mesh_.vertices.col(v)).norm();
        // Distances from two sources have no common place to unfold from.
        if (source_[static_cast<std::size_t>(known)] == number) found = std::min(found, over(v, known, wanted));
        reach(wanted, found);
      }
    }
  }
}

}  // namespace taut::detail
