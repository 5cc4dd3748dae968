#include "surface/local_fit/patch_cover.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"
#include "surface/rbf/cloud_geometry.hpp"

namespace taut::detail {
namespace {

/// Samples of a patch in the plane and in space. Fewer leave the cubic to the straightness term; twice as many leave
/// misses half as large again on the vertices of ten meshes (docs/measured/local_fit.md).
constexpr Index kFewestInPlane = 8;
constexpr Index kFewestInSpace = 18;

// The ladder of sizes that cross-validation tries: each half as large again.
constexpr int kRungs = 8;
constexpr double kGrowth = 1.5;
/// A larger patch is smoother and cheaper: it is taken where it predicts samples this much worse than the best.
constexpr double kAsGood = 1.05;
/// Beyond a rung that is so much worse than the best none is tried.
constexpr double kHopeless = 1.3;
/// Each probe speaks for so many samples around it; the median of three probes decides.
constexpr Index kSamplesPerProbe = 30;
constexpr Index kProbesAsked = 3;

/// A sample within this part of a ball's radius needs no ball of its own: five or six balls then hold each point.
/// 1 / 1.7 leaves a fifth larger misses, 1 / 2.4 costs twice as much and gains a seventh (torus, kitten).
constexpr double kCovered = 0.5;
constexpr double kBeyondLast = 1.1;  // where no further sample tells where a ball ends

constexpr Index kGrain = 16;

/// The radius of a ball around x that holds the `count` nearest of `found`, which has one more if there is one.
double radius_for(const std::vector<Neighbour>& found, Index count) {
  const double last = std::sqrt(found.back().squared_distance);
  return static_cast<Index>(found.size()) > count ? last : kBeyondLast * last;
}

template <int D>
std::array<double, D> point_of(const Points& points, Index i) {
  std::array<double, D> x{};
  for (int a = 0; a < D; ++a) x[static_cast<std::size_t>(a)] = points(a, i);
  return x;
}

template <int D>
int best_rung(OrientedSamples samples, const KdTree& tree, Index at, PatchSolver<D>& solver) {
  const Index targets = fewest_samples(D) / 2;
  std::array<double, kRungs> error{};
  std::vector<Neighbour> found;
  double least = HUGE_VAL;
  int rung = 0;
  for (auto count = static_cast<double>(fewest_samples(D)); rung < kRungs; ++rung, count *= kGrowth) {
    const auto wanted = static_cast<Index>(count);
    if (wanted > samples.points.cols()) break;
    tree.nearest(samples.points.col(at).data(), wanted + 1, found);
    const double radius = radius_for(found, wanted);
    if (static_cast<Index>(found.size()) > wanted) found.pop_back();
    (void)solver.fit(point_of<D>(samples.points, at), radius, found);
    error[static_cast<std::size_t>(rung)] = solver.left_out(targets);
    least = std::min(least, error[static_cast<std::size_t>(rung)]);
    if (error[static_cast<std::size_t>(rung)] > kHopeless * least) break;
  }
  for (int best = rung; best-- > 0;) {
    if (error[static_cast<std::size_t>(best)] <= kAsGood * least) return best;
  }
  return 0;
}

template <int D>
std::vector<Index> by_cross_validation(OrientedSamples samples, const KdTree& tree, const Context& context) {
  const Index n = samples.points.cols();
  const std::vector<Index> probes = spread_by_count(samples.points, tree, kSamplesPerProbe);
  std::vector<int> rung(probes.size());
  parallel_for(context, 0, static_cast<Index>(probes.size()), kGrain, [&](Index first, Index last) {
    PatchSolver<D> solver(samples);
    for (Index i = first; i < last; ++i) {
      const auto at = static_cast<std::size_t>(i);
      rung[at] = best_rung<D>(samples, tree, probes[at], solver);
    }
  });
  const Points probe_points = samples.points(Eigen::all, probes);
  const KdTree probe_tree(probe_points);
  std::vector<Index> wanted(static_cast<std::size_t>(n));
  constexpr Index kSampleGrain = 1024;
  parallel_for(context, 0, n, kSampleGrain, [&](Index first, Index last) {
    std::vector<Neighbour> near;
    std::vector<int> rungs;
    for (Index i = first; i < last; ++i) {
      probe_tree.nearest(samples.points.col(i).data(), kProbesAsked, near);
      rungs.clear();
      for (const Neighbour& probe : near) rungs.push_back(rung[static_cast<std::size_t>(probe.index)]);
      std::sort(rungs.begin(), rungs.end());
      const double count = static_cast<double>(fewest_samples(D)) * std::pow(kGrowth, rungs[(rungs.size() - 1) / 2]);
      wanted[static_cast<std::size_t>(i)] = static_cast<Index>(count);
    }
  });
  return wanted;
}

}  // namespace

Index fewest_samples(Index dim) { return dim == 2 ? kFewestInPlane : kFewestInSpace; }

std::vector<Index> samples_by_cross_validation(OrientedSamples samples, const KdTree& tree, const Context& context) {
  return samples.points.rows() == 2 ? by_cross_validation<2>(samples, tree, context)
                                    : by_cross_validation<3>(samples, tree, context);
}

std::vector<Ball> cover(const Points& points, const KdTree& tree, const BallWishes& wishes, const Context& context) {
  constexpr Index kBetweenChecks = 1024;
  std::vector<Ball> balls;
  std::vector<bool> covered(static_cast<std::size_t>(points.cols()), false);
  std::vector<Neighbour> found;
  Index visited = 0;
  const auto add = [&](Index i) {
    if (++visited % kBetweenChecks == 0) context.check_cancelled();
    const Index count = wishes.samples[static_cast<std::size_t>(i)];
    tree.nearest(points.col(i).data(), count + 1, found);
    const double by_count = radius_for(found, count);
    const double radius = std::max(by_count, wishes.radius(i));
    balls.push_back({i, radius});
    if (radius > by_count) tree.within(points.col(i).data(), kCovered * radius, found);
    for (const Neighbour& neighbour : found) {
      if (neighbour.squared_distance > kCovered * kCovered * radius * radius) break;
      covered[static_cast<std::size_t>(neighbour.index)] = true;
    }
  };
  const std::vector<Index> order = scrambled_order(points.cols());
  for (const Index i : order) {
    if (wishes.own[static_cast<std::size_t>(i)]) add(i);
  }
  for (const Index i : order) {
    if (!covered[static_cast<std::size_t>(i)]) add(i);
  }
  return balls;
}

}  // namespace taut::detail
