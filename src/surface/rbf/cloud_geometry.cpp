#include "surface/rbf/cloud_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "core/linear_algebra.hpp"
#include "core/parallel.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

std::uint64_t scramble(std::uint64_t x) {  // splitmix64's finaliser
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

double unit_ball_volume(double m) { return std::pow(std::numbers::pi, m / 2) / std::tgamma(m / 2 + 1); }

}  // namespace

std::vector<Index> scrambled_order(Index n) {
  std::vector<std::pair<std::uint64_t, Index>> keyed;
  keyed.reserve(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) keyed.emplace_back(scramble(static_cast<std::uint64_t>(i)), i);
  std::sort(keyed.begin(), keyed.end());
  std::vector<Index> order;
  order.reserve(keyed.size());
  for (const auto& [key, index] : keyed) order.push_back(index);
  return order;
}

void require_finite(const Points& points, std::string_view what) {
  for (Index j = 0; j < points.cols(); ++j) {
    if (!points.col(j).allFinite()) {
      throw InvalidArgument(std::string(what) + " " + std::to_string(j) + " has a coordinate that is not finite");
    }
  }
}

MergedPoints merge_duplicates(const Points& points) {
  const Index n = points.cols();
  const auto less = [&](Index a, Index b) {
    for (Index axis = 0; axis < points.rows(); ++axis) {
      if (points(axis, a) != points(axis, b)) return points(axis, a) < points(axis, b);
    }
    return a < b;
  };
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), less);
  // The first of each run of equals has the smallest index.
  std::vector<Index> first_of(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && points.col(order[i]) == points.col(order[i - 1]);
    first_of[static_cast<std::size_t>(order[i])] =
        repeats ? first_of[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  MergedPoints merged;
  merged.merged_to.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (first_of[i] == static_cast<Index>(i)) {
      merged.merged_to[i] = static_cast<Index>(merged.merged_from.size());
      merged.merged_from.push_back(static_cast<Index>(i));
    } else {
      merged.merged_to[i] = merged.merged_to[static_cast<std::size_t>(first_of[i])];
    }
  }
  merged.points = points(Eigen::all, merged.merged_from);
  return merged;
}

Index affine_rank(const Points& points, double tolerance) {
  if (points.cols() == 0) return 0;
  const Vector mean = points.rowwise().mean();
  const Points centred = points.colwise() - mean;
  const double size = centred.cwiseAbs().maxCoeff();
  if (!(size > 0)) return 0;
  const Eigen::MatrixXd moment = (centred / size) * (centred / size).transpose();
  const Vector spread = singular_values(moment).cwiseSqrt();
  // Squaring leaves half of the digits: spreads below 1e-8 of the largest cannot be told from none.
  return (spread.array() > std::max(tolerance, 3e-8) * spread(0)).count();
}

Vector local_spacing(const Points& points, const KdTree& tree, const Context& context) {
  constexpr Index kNeighbours = 8;
  constexpr Index kGrain = 1024;
  const Index n = points.cols();
  const auto m = static_cast<double>(points.rows() - 1);
  Vector spacing = Vector::Zero(n);
  parallel_for(context, 0, n, kGrain, [&](Index first, Index last) {
    std::vector<Neighbour> found;
    for (Index i = first; i < last; ++i) {
      tree.nearest(points.col(i).data(), kNeighbours + 1, found);
      const auto k = static_cast<double>(found.size() - 1);
      if (k < 1) continue;
      spacing(i) = std::sqrt(found.back().squared_distance) * std::pow(unit_ball_volume(m) / k, 1 / m);
    }
  });
  return spacing;
}

double relative_noise(const Points& points, const Points& normals, const KdTree& tree) {
  const Index d = points.rows();
  const Index m = d - 1;
  const Index unknowns = 1 + m + m * (m + 1) / 2;
  const Index neighbours = 4 * unknowns;
  if (d > 5 || points.cols() < 2 * neighbours) return 0;
  constexpr Index kMaxProbes = 1000;
  const Index num_probes = std::min(points.cols(), kMaxProbes);
  Vector ratio = Vector::Constant(num_probes, std::numeric_limits<double>::quiet_NaN());
  std::vector<Neighbour> found;
  for (Index probe = 0; probe < num_probes; ++probe) {
    const Index i = probe * points.cols() / num_probes;
    const Vector normal = normals.col(i);
    // Twice as many, since half of those around a thin sheet lie on its other face.
    tree.nearest(points.col(i).data(), 2 * neighbours, found);
    std::erase_if(found, [&](const Neighbour& other) { return normals.col(other.index).dot(normal) <= 0; });
    const Index used = std::min(neighbours, static_cast<Index>(found.size()));
    if (used < 2 * unknowns) continue;
    const Eigen::MatrixXd tangents = orthogonal_complement(normal);
    const double radius = std::sqrt(found[static_cast<std::size_t>(used - 1)].squared_distance);
    Eigen::MatrixXd terms(used, unknowns);
    Vector height(used);
    for (Index row = 0; row < used; ++row) {
      const Vector u = (points.col(found[static_cast<std::size_t>(row)].index) - points.col(i)) / radius;
      const Vector t = tangents.transpose() * u;
      height(row) = normal.dot(u);
      terms(row, 0) = 1;
      terms.row(row).segment(1, m) = t.transpose();
      for (Index a = 0, column = 1 + m; a < m; ++a) {
        for (Index b = 0; b <= a; ++b, ++column) terms(row, column) = t(a) * t(b);
      }
    }
    const Vector fit = least_squares(terms, height);
    const double deviation = std::sqrt((terms * fit - height).squaredNorm() / static_cast<double>(used - unknowns));
    // radius = 1 here, so the spacing is that of `used` points in a unit ball.
    ratio(probe) = deviation / std::pow(unit_ball_volume(static_cast<double>(m)) / static_cast<double>(used),
                                        1 / static_cast<double>(m));
  }
  return quantile(ratio, 0.1);
}

double quantile(const Vector& values, double q) {
  std::vector<double> sorted;
  sorted.reserve(static_cast<std::size_t>(values.size()));
  for (const double value : values) {
    if (std::isfinite(value)) sorted.push_back(value);
  }
  if (sorted.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(sorted.size() - 1) + 0.5);
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
}

std::vector<Index> spread_by_count(const Points& points, const KdTree& tree, Index count) {
  std::vector<bool> covered(static_cast<std::size_t>(points.cols()), false);
  std::vector<Index> chosen;
  std::vector<Neighbour> found;
  for (const Index i : scrambled_order(points.cols())) {
    if (covered[static_cast<std::size_t>(i)]) continue;
    chosen.push_back(i);
    tree.nearest(points.col(i).data(), count, found);
    for (const Neighbour& neighbour : found) covered[static_cast<std::size_t>(neighbour.index)] = true;
  }
  return chosen;
}

std::vector<Index> spread_subset(const Points& points, const KdTree& tree, double radius) {
  std::vector<bool> covered(static_cast<std::size_t>(points.cols()), false);
  std::vector<Index> chosen;
  std::vector<Neighbour> found;
  for (const Index i : scrambled_order(points.cols())) {
    if (covered[static_cast<std::size_t>(i)]) continue;
    chosen.push_back(i);
    tree.within(points.col(i).data(), radius, found);
    for (const Neighbour& neighbour : found) covered[static_cast<std::size_t>(neighbour.index)] = true;
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<Index> spread_subset_of_size(const Points& points, const KdTree& tree, Index max_size) {
  const auto m = static_cast<double>(points.rows() - 1);
  const auto wanted = 0.98 * static_cast<double>(max_size);
  const double spacing = quantile(local_spacing(points, tree), 0.5);
  double low = 0;   // too many points
  double high = 0;  // few enough; 0 = not yet known
  double radius = spacing * std::pow(static_cast<double>(points.cols()) / wanted, 1 / m);
  std::vector<Index> best;
  constexpr int kMaxPasses = 16;
  for (int pass = 0; pass < kMaxPasses || best.empty(); ++pass) {
    std::vector<Index> subset = spread_subset(points, tree, radius);
    const auto size = static_cast<double>(subset.size());
    if (static_cast<Index>(subset.size()) <= max_size) {
      high = radius;
      if (subset.size() > best.size()) best = std::move(subset);
      if (size >= 0.96 * static_cast<double>(max_size)) break;
    } else {
      low = radius;
    }
    // The size falls like radius^-m; stay inside what is known.
    const double guess = radius * std::pow(size / wanted, 1 / m);
    const bool inside = guess > low && (high == 0 || guess < high);
    radius = inside ? guess : high > 0 ? 0.5 * (low + high) : 2 * radius;
  }
  return best;
}

}  // namespace taut::detail
