#include "surface/normals/spread_normals.hpp"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.hpp"
#include "core/parallel.hpp"
#include "surface/rbf/cloud_geometry.hpp"

namespace taut::detail {
namespace {

constexpr Index kGrain = 256;

/// Directions and spreads of a set of points, D a constant for the plane and space.
template <int D>
struct Spread {
  using Direction = Eigen::Matrix<double, D, 1>;
  using Square = Eigen::Matrix<double, D, D>;

  Spread(const Points& points, const std::vector<Neighbour>& found) {
    const Index d = points.rows();
    Direction mean = Direction::Zero(d);
    for (const Neighbour& q : found) mean += points.col(q.index);
    mean /= static_cast<double>(found.size());
    Square moment = Square::Zero(d, d);
    for (const Neighbour& q : found) {
      const Direction u = points.col(q.index) - mean;
      moment.noalias() += u * u.transpose();
    }
    eigen = symmetric_eigen(moment);
  }
  /// Do the points determine a hyperplane?
  [[nodiscard]] bool determined() const {
    const auto& values = eigen.values;
    return values(1) > 1e-12 * values(values.size() - 1);
  }
  /// Spread across the sheet beside the least spread within it.
  [[nodiscard]] double thickness() const {
    const auto& values = eigen.values;
    return values(1) > 0 ? std::sqrt(std::max(values(0), 0.0) / values(1)) : 0;
  }

  SymmetricEigen<Square> eigen;
};

template <int D>
void least_spread_in(const Points& points, const KdTree& tree, const std::vector<Index>& at, Index neighbours,
                     const Context& context, Points& normals) {
  parallel_for(context, 0, static_cast<Index>(at.size()), kGrain, [&](Index first, Index last) {
    std::vector<Neighbour> found;
    for (Index i = first; i < last; ++i) {
      for (Index count = neighbours;; count *= 2) {
        tree.nearest(points.col(at[static_cast<std::size_t>(i)]).data(), count, found);
        const Spread<D> spread(points, found);
        normals.col(i) = spread.eigen.vectors.col(0);
        if (spread.determined() || static_cast<Index>(found.size()) == points.cols()) break;
      }
    }
  });
}

/// The median over some points.
double thickness(const Points& points, const KdTree& tree, Index neighbours) {
  constexpr Index kMaxProbes = 500;
  const Index num_probes = std::min(points.cols(), kMaxProbes);
  Vector found_thickness(num_probes);
  std::vector<Neighbour> found;
  for (Index probe = 0; probe < num_probes; ++probe) {
    tree.nearest(points.col(probe * points.cols() / num_probes).data(), neighbours, found);
    found_thickness(probe) = Spread<Eigen::Dynamic>(points, found).thickness();
  }
  return quantile(found_thickness, 0.5);
}

}  // namespace

Points least_spread(const Points& points, const KdTree& tree, const std::vector<Index>& at, Index neighbours,
                    const Context& context) {
  Points normals(points.rows(), static_cast<Index>(at.size()));
  if (points.rows() == 2) {
    least_spread_in<2>(points, tree, at, neighbours, context, normals);
  } else if (points.rows() == 3) {
    least_spread_in<3>(points, tree, at, neighbours, context, normals);
  } else {
    least_spread_in<Eigen::Dynamic>(points, tree, at, neighbours, context, normals);
  }
  return normals;
}

Index neighbours_for_noise(const Points& points, const KdTree& tree, Index neighbours, const Context& context) {
  constexpr double kThick = 0.12;  // the normal's error is about this, radians, and more neighbours may help
  // Where noise is all that spreads across, twice the neighbours leave 0.71 of it; where the sheet bends, 1.41.
  constexpr double kClearlyLess = 0.85;
  constexpr Index kMost = 320;
  double before = thickness(points, tree, neighbours);
  while (before > kThick && 2 * neighbours <= std::min(kMost, points.cols() / 4)) {
    context.check_cancelled();
    const double after = thickness(points, tree, 2 * neighbours);
    if (after > kClearlyLess * before) break;
    neighbours *= 2;
    before = after;
  }
  return neighbours;
}

}  // namespace taut::detail
