#include "surface/normals/layered_noise.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "surface/normals/sample_quadric.hpp"
#include "surface/rbf/cloud_geometry.hpp"

// Two faces of a plate with noise of 0.3 of their gap cannot be parted sample by sample, but together: the distances of
// some hundred samples from one sheet through all of them are normally distributed about it when there is one sheet,
// and have two humps when there are two. Each sample's distance is taken from the quadric through its neighbours, in
// terms of what those scatter by; over a region of kRegion samples a mixture of two normal distributions with one
// deviation is compared with a single normal distribution by the logarithm of their likelihoods.
//
// Shape that the quadric does not follow (waves of a few spacings, creases) leaves distances with two humps, too, but
// fewer samples follow it better; noise scatters the same on any number of them.
//
// LLR measured on plates of 21 x 21 samples a face, grids and random, flat and bent, gaps of 0.3 to 1 spacings, by
// noise in gaps, and on one noisy sheet: docs/measured/local_fit.md.

namespace taut::detail {
namespace {

constexpr Index kWindow = 48;
static_assert(kWindow <= kMostAround);
constexpr Index kFewestInWindow = 24;
constexpr Index kRegion = 800;
/// 40,000 samples have 100; a third of them, spread, says as much and takes a third of the time.
constexpr Index kMostRegions = 32;
constexpr Index kGrain = 64;
/// Logarithm of the likelihoods' ratio. Below: one sheet, and an armadillo that is rough at its own spacing (7 to 12).
constexpr double kLeastLlr = 15;
/// Gap of the layers in their own deviations. Below 2 there is one hump.
constexpr double kLeastGap = 2;
/// Share of the samples in the smaller layer.
constexpr double kLeastShare = 0.15;
/// Half of the window scatters as much as all of it, by noise; by shape, less.
constexpr double kLeastNear = 0.7;
/// Of all regions: a doubt concerns every path. Of a fused scan (sven) 6 % are layers a tenth of a spacing apart.
constexpr double kFewOfAll = 0.1;

struct Distance {
  double scaled = 0;     // from the quadric, in deviations
  double near = 0;       // the deviation of the nearer half from a quadric of its own, in deviations of all
  double deviation = 0;  // model units
};

class Window {
 public:
  Window(const Points& points, const Points& normals, const KdTree& tree)
      : points_(points), normals_(normals), tree_(tree), u_(points.rows(), kWindow), local_(points.rows(), kWindow) {}

  std::optional<Distance> operator()(Index i) {
    const auto other_way = [&](const Neighbour& near) { return normals_.col(near.index).dot(normals_.col(i)) <= 0; };
    tree_.nearest(points_.col(i).data(), kWindow, found_);
    if (std::any_of(found_.begin(), found_.end(), other_way)) {
      tree_.nearest(points_.col(i).data(), 2 * kWindow, found_);
      std::erase_if(found_, other_way);
    }
    const Index n = std::min(kWindow, static_cast<Index>(found_.size()));
    if (n < kFewestInWindow || found_.front().index != i) return std::nullopt;
    const double radius = std::sqrt(found_[static_cast<std::size_t>(n - 1)].squared_distance);
    if (!(radius > 0)) return std::nullopt;
    for (Index j = 0; j < n; ++j)
      u_.col(j) = (points_.col(found_[static_cast<std::size_t>(j)].index) - points_.col(i)) / radius;
    const auto u = u_.leftCols(n);
    Axes axes = axes_by_spread(u);  // the first across the sheet
    if (axes.col(0).dot(normals_.col(i)) < 0) axes.col(0) *= -1;
    local_.leftCols(n) = axes.transpose().lazyProduct(u);
    const double near = scatter_of(n / 2).deviation;
    const Scatter all = scatter_of(n);
    if (!(all.deviation > kExact)) return std::nullopt;
    return Distance{all.own / all.deviation, near / all.deviation, all.deviation * radius};
  }

 private:
  static constexpr double kExact = 1e-9;  // of the window: rounding

  struct Scatter {
    double own = 0;        // the sample's distance from the quadric
    double deviation = 0;  // of all
  };

  /// About the quadric through the nearest n.
  [[nodiscard]] Scatter scatter_of(Index n) const {
    const Index num_tangents = local_.rows() - 1;
    AroundTerms terms(num_quadric_terms(num_tangents), n);
    for (Index j = 0; j < n; ++j) terms.col(j) = quadric_terms(local_.col(j).tail(num_tangents));
    const TermVector quadric = fit_terms(terms, local_.row(0).head(n).eval());
    Scatter scatter;
    for (Index j = 0; j < n; ++j) {
      const double rest = local_(0, j) - quadric.dot(terms.col(j));
      if (j == 0) scatter.own = rest;
      scatter.deviation += rest * rest;
    }
    scatter.deviation = std::sqrt(scatter.deviation / static_cast<double>(n - terms.rows()));
    return scatter;
  }

  const Points& points_;
  const Points& normals_;
  const KdTree& tree_;
  std::vector<Neighbour> found_;
  Around u_;      // the nearest, seen from the sample, the farthest at 1
  Around local_;  // the same, the first coordinate across the sheet
};

/// Two normal distributions of one deviation, fitted to values by expectation and maximisation in turns.
struct Layers {
  double share = 0.5;  // of the upper one
  double gap = 0;      // in deviations of one layer
  double llr = 0;      // over a single normal distribution
  double height = 0;   // the gap, in the unit of the values
};

Layers fit_layers(const std::vector<Distance>& distances) {
  constexpr int kMostTurns = 200;
  constexpr double kAtRest = 1e-4;
  constexpr double kLeastDeviation = 1e-3;
  const auto n = static_cast<double>(distances.size());
  double mean = 0;
  double squares = 0;
  for (const Distance& at : distances) mean += at.scaled / n;
  for (const Distance& at : distances) squares += (at.scaled - mean) * (at.scaled - mean) / n;
  const double all = std::sqrt(squares);
  const double single = -n * (std::log(all) + 0.5);
  double low = mean - all;
  double high = mean + all;
  double deviation = 0.5 * all;
  double share = 0.5;
  double before = -HUGE_VAL;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    double likelihood = 0;
    double upper = 0;
    double sum_upper = 0;
    double sum_lower = 0;
    double rest = 0;
    for (const Distance& at : distances) {
      const double x = at.scaled;
      const double a = share * std::exp(-0.5 * std::pow((x - high) / deviation, 2));
      const double b = (1 - share) * std::exp(-0.5 * std::pow((x - low) / deviation, 2));
      const double both = std::max(a + b, 1e-300);
      likelihood += std::log(both / deviation);
      const double is_upper = a / both;
      upper += is_upper;
      sum_upper += is_upper * x;
      sum_lower += (1 - is_upper) * x;
      rest += is_upper * (x - high) * (x - high) + (1 - is_upper) * (x - low) * (x - low);
    }
    if (!(upper > 1 && upper < n - 1)) return {};
    const Layers layers{share, (high - low) / deviation, likelihood - single, high - low};
    if (likelihood - before < kAtRest) return layers;
    before = likelihood;
    share = upper / n;
    high = sum_upper / upper;
    low = sum_lower / (n - upper);
    deviation = std::max(std::sqrt(rest / n), kLeastDeviation * all);
  }
  return {share, (high - low) / deviation, before - single, high - low};
}

MergedSheets find(const Points& points, const Points& normals, const KdTree& tree, const Context& context) {
  const Index region = std::min(kRegion, points.cols());
  std::vector<Index> centres = spread_by_count(points, tree, region);
  if (static_cast<Index>(centres.size()) > kMostRegions) centres.resize(kMostRegions);
  MergedSheets merged;
  double gaps = 0;
  std::vector<Neighbour> members;
  std::vector<std::optional<Distance>> found(static_cast<std::size_t>(region));
  std::vector<Distance> distances;
  for (const Index centre : centres) {
    context.check_cancelled();
    tree.nearest(points.col(centre).data(), region, members);
    parallel_for(context, 0, static_cast<Index>(members.size()), kGrain, [&](Index first, Index last) {
      Window window(points, normals, tree);
      for (Index i = first; i < last; ++i) {
        found[static_cast<std::size_t>(i)] = window(members[static_cast<std::size_t>(i)].index);
      }
    });
    distances.clear();
    double scatter = 0;
    double near = 0;
    for (const std::optional<Distance>& at : found) {
      if (!at) continue;
      distances.push_back(*at);
      scatter += at->deviation;
      near += at->near;
    }
    if (static_cast<Index>(distances.size()) < kWindow) continue;
    const Layers layers = fit_layers(distances);
    if (layers.llr < kLeastLlr || layers.gap < kLeastGap || std::min(layers.share, 1 - layers.share) < kLeastShare ||
        near < kLeastNear * static_cast<double>(distances.size())) {
      continue;
    }
    if (merged.count++ == 0) merged.at = centre;
    gaps += layers.height * scatter / static_cast<double>(distances.size());
  }
  const auto num_regions = static_cast<double>(centres.size());
  if (static_cast<double>(merged.count) <= kFewOfAll * num_regions) return {};
  merged.gap = gaps / static_cast<double>(merged.count);
  merged.count =
      static_cast<Index>(static_cast<double>(merged.count) / num_regions * static_cast<double>(points.cols()));
  return merged;
}

}  // namespace

MergedSheets find_layered_noise(const Points& points, const Points& normals, const KdTree& tree,
                                const Context& context) {
  if (points.cols() < 2 * kWindow || points.rows() > 3) return {};
  return find(points, normals, tree, context);
}

}  // namespace taut::detail
