#include "surface/local_fit/support_radii.hpp"

#include <algorithm>
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
/// Of the longest edge at a vertex: a point of a triangle is no farther than 1 / sqrt(3) = 0.58 of it from a corner.
constexpr double kEdges = 0.6;
/// A sample alone far out is no reason for surface there: at most so many times what suits 95 % of the samples.
constexpr double kMostOfTypical = 3;

constexpr Index kRimNeighbours = 16;
/// The mean of neighbours on all sides is 0 +- 0.16 radii from a sample, on one side 0.42.
constexpr double kOneSided = 0.3;

constexpr Index kGrain = 1024;

}  // namespace

Vector support_radii(OrientedSamples samples, const KdTree& tree, const Vector& spacing, const Eigen::Matrix3Xi& faces,
                     const std::vector<Index>& merged_to, const Context& context) {
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
  radius = radius.cwiseMin(kMostOfTypical * typical).cwiseMin(between);
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const Index a = merged_to[static_cast<std::size_t>(faces(corner, f))];
      const Index b = merged_to[static_cast<std::size_t>(faces((corner + 1) % 3, f))];
      const double reach = kEdges * (points.col(a) - points.col(b)).norm();
      radius(a) = std::max(radius(a), reach);
      radius(b) = std::max(radius(b), reach);
    }
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
