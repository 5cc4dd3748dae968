#include "search/cell_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "surface/rbf/kd_tree.hpp"

namespace taut::detail {
namespace {

/// Cells along the longest side of the box, for d = 2, 3, 4, 5 and from 6 on.
constexpr std::array<double, 5> kCellsPerSide = {128, 32, 16, 9, 6};
/// A cloud of many points does not make the cells finer than this.
constexpr double kMostCellsPerSide = 160;
/// Distance to the k-th neighbour tells the density; the nearest alone is fooled by overlapping scans.
constexpr Index kNeighbour = 6;
constexpr Index kProbes = 400;

/// Typical distance between neighbouring samples of a surface (two-dimensional for d = 3): on average k of them lie
/// within r_k, so the area a sample stands for is pi r_k^2 / k.
double sample_spacing(const Points& points) {
  const KdTree tree(points);
  std::vector<double> radii;
  std::vector<Neighbour> nearest;
  const Index step = std::max<Index>(1, points.cols() / kProbes);
  for (Index j = 0; j < points.cols(); j += step) {
    tree.nearest(points.col(j).data(), kNeighbour + 1, nearest);  // the first one is the sample itself
    radii.push_back(std::sqrt(nearest.back().squared_distance));
  }
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle * std::sqrt(std::numbers::pi / kNeighbour);
}

}  // namespace

double cell_size_for_box(const Box& box) {
  const auto d = static_cast<std::size_t>(std::clamp<Index>(box.dim(), 2, 6));
  return box.extent().maxCoeff() / kCellsPerSide.at(d - 2);
}

double cell_size_for_samples(const PointCloud& samples) {
  const Box box{samples.points.rowwise().minCoeff(), samples.points.rowwise().maxCoeff()};
  const double coarse = cell_size_for_box(box);
  if (samples.size() < 2 * kNeighbour) return coarse;
  const double finest = box.extent().maxCoeff() / kMostCellsPerSide;
  // Two spacings: a cell holds a few samples of one layer.
  return std::clamp(2 * sample_spacing(samples.points), std::min(finest, coarse), coarse);
}

}  // namespace taut::detail
