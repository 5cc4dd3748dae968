#include "surface/local_fit/support_radii.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/parallel.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "surface/rbf/support_radius.hpp"

namespace taut::detail {
namespace {

constexpr Index kNeighbours = 8;
/// Times the largest spacing among a sample's neighbours. Of a random sample that is 1.3 spacings, so that holes of up
/// to 2.2 spacings are filled, what default_support_radius found to be needed.
constexpr double kHoles = 1.75;
/// A sample alone far out is no reason for surface there: at most so many times what suits 95 % of the samples.
constexpr double kMostOfTypical = 3;

/// Of the longest edge at a vertex: a point of a triangle is no farther than 1 / sqrt(3) = 0.58 of it from a corner.
/// With 0.9 more bubbles stay inside, with 0.6 three times as many faces need places.
constexpr double kOfEdge = 0.7;
/// Radians between the normals of a vertex and of its faces: beyond, it speaks the less the more they turn, and places
/// over the faces take over.
constexpr double kGentle = 0.35;

constexpr Index kRimNeighbours = 16;
/// The mean of neighbours on all sides is 0 +- 0.16 radii from a sample, on one side 0.42.
constexpr double kOneSided = 0.3;

constexpr Index kGrain = 1024;

/// body(corners) for every face.
template <class Body>
void for_faces(const FacedSamples& mesh, const Body& body) {
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    std::array<Index, 3> corners{};
    for (int i = 0; i < 3; ++i) {
      corners[static_cast<std::size_t>(i)] = mesh.merged_to[static_cast<std::size_t>(mesh.faces(i, f))];
    }
    body(corners);
  }
}

}  // namespace

Vector support_radii(OrientedSamples samples, const KdTree& tree, const Vector& spacing, const Context& context) {
  const Points& points = samples.points;
  const Index n = points.cols();
  Vector radius(n);
  parallel_for(context, 0, n, kGrain, [&](Index first, Index last) {
    std::vector<Neighbour> near;
    for (Index i = first; i < last; ++i) {
      tree.nearest(points.col(i).data(), kNeighbours, near);
      double most = 0;
      for (const Neighbour& q : near) most = std::max(most, spacing(q.index));
      radius(i) = kHoles * most;
    }
  });
  const double typical = quantile(radius, 0.95);
  // Where sheets that face the same way lie close, that decides.
  const double between = support_between_sheets(points, samples.normals, tree, spacing);
  return radius.cwiseMin(kMostOfTypical * typical).cwiseMin(between);
}

Vector longest_edges(const FacedSamples& mesh) {
  const Points& points = mesh.samples.points;
  Vector longest = Vector::Zero(points.cols());
  for_faces(mesh, [&](const std::array<Index, 3>& corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = corners[i];
      const Index b = corners[(i + 1) % 3];
      const double length = (points.col(a) - points.col(b)).norm();
      longest(a) = std::max(longest(a), length);
      longest(b) = std::max(longest(b), length);
    }
  });
  return longest;
}

Vector support_of_vertices(const FacedSamples& mesh, const Vector& most) {
  const auto& [points, normals] = mesh.samples;
  Vector gentlest = Vector::Ones(points.cols());  // cosine of the normal's angle to the faces'
  for_faces(mesh, [&](const std::array<Index, 3>& corners) {
    const Eigen::Vector3d a = points.col(corners[0]);
    const Eigen::Vector3d b = points.col(corners[1]);
    const Eigen::Vector3d c = points.col(corners[2]);
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > 0)) return;
    for (const Index i : corners)
      gentlest(i) = std::min(gentlest(i), std::abs(normal.normalized().dot(normals.col(i))));
  });
  const Vector longest = longest_edges(mesh);
  Vector radius = most;
  for (Index i = 0; i < radius.size(); ++i) {
    if (!(longest(i) > 0)) continue;
    const double turn = std::acos(gentlest(i));
    radius(i) = std::min(radius(i), kOfEdge * longest(i) / std::max(1.0, turn / kGentle));
  }
  return radius;
}

std::vector<bool> find_rim(OrientedSamples samples, const KdTree& tree, const Context& context) {
  const Points& points = samples.points;
  const Index n = points.cols();
  std::vector<std::uint8_t> one_sided(static_cast<std::size_t>(n));
  parallel_for(context, 0, n, kGrain, [&](Index first, Index last) {
    std::vector<Neighbour> near;
    Vector mean(points.rows());
    for (Index i = first; i < last; ++i) {
      tree.nearest(points.col(i).data(), kRimNeighbours + 1, near);
      mean.setZero();
      for (const Neighbour& q : near) mean += points.col(q.index) - points.col(i);
      mean /= static_cast<double>(near.size());
      mean -= samples.normals.col(i).dot(mean) * samples.normals.col(i);
      const double radius = std::sqrt(near.back().squared_distance);
      one_sided[static_cast<std::size_t>(i)] = mean.norm() > kOneSided * radius ? 1 : 0;
    }
  });
  return {one_sided.begin(), one_sided.end()};
}

}  // namespace taut::detail
