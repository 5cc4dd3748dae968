#include "surface/normals/bridged_gap.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/linear_algebra.hpp"
#include "core/parallel.hpp"
#include "surface/normals/sample_quadric.hpp"

// With h the height along the normal and t the place across it, the samples around one that face its way and those that
// face away are h = a + b.t + t^T C t +- gap / 2, by least squares: noise averages out. Where the one's outsides are
// away from each other (the faces of a plate) F is negative in the middle, between two bodies positive, and as deep as
// a parabola is that vanishes on both with slope 1: a quarter of the gap. Where it is not, or has not this sign
// half-way to a neighbour, F goes from one sheet to the other.

namespace taut::detail {
namespace {

constexpr Index kNearest = 24;
/// So many of them at least face the other way: thinner than the samples are apart.
constexpr Index kFewest = 6;
constexpr double kOtherWay = -0.5;  // cosine
constexpr double kSameWay = 0.5;
/// The gap beside what the two sheets leave (standard deviation): below, the fit of two says nothing.
constexpr double kLeastGap = 1.5;
/// Of the parabola's depth.
constexpr double kLeastDepth = 0.25 * 0.4;
/// How far the middle of those that face the other way may lie aside, in radii of the neighbourhood: of a sample at a
/// rim it is 0.42, of 12 random ones all around 0.2.
constexpr double kMostAside = 0.33;
/// Of all samples looked at: a doubt concerns every path. A tunnel through a plate of 882 samples is seen by 5 to 20.
constexpr double kFewOfAll = 0.005;
constexpr Index kMostProbes = 20000;
constexpr Index kGrain = 64;

class Probe {
 public:
  Probe(const Points& points, const Points& normals, const KdTree& tree, const ImplicitFunction& function)
      : points_(points), normals_(normals), tree_(tree), evaluator_(function.make_evaluator()) {}

  /// The width of a gap that F bridges at sample i, 0 = none.
  double operator()(Index i) {
    tree_.nearest(points_.col(i).data(), kNearest, found_);
    const Direction normal = normals_.col(i);
    Index other_way = 0;
    for (const Neighbour& near : found_) {
      if (normals_.col(near.index).dot(normal) < kOtherWay) ++other_way;
    }
    if (other_way < kFewest) return 0;
    const double radius = std::sqrt(found_.back().squared_distance);
    if (!(radius > 0)) return 0;
    const Axes tangents = orthogonal_complement(normal);
    const Index num_tangents = tangents.cols();
    const Index num_terms = num_quadric_terms(num_tangents);
    AroundTerms terms(num_terms + 1, kNearest);
    AroundRow height(kNearest);
    Around places(num_tangents, kNearest);
    Index n = 0;
    Index same_way = 0;
    Direction aside = Direction::Zero(num_tangents);
    for (const Neighbour& near : found_) {
      const double cosine = normals_.col(near.index).dot(normal);
      if (std::abs(cosine) < kSameWay) continue;  // of a rim
      const Direction u = (points_.col(near.index) - points_.col(i)) / radius;
      const Direction place = tangents.transpose().lazyProduct(u);
      terms.col(n) << quadric_terms(place), (cosine > 0 ? 0.5 : -0.5);
      height(n++) = normal.dot(u);
      if (cosine > 0) {
        places.col(same_way++) = place;
      } else {
        aside += place / static_cast<double>(other_way);
      }
    }
    if (n < 2 * (num_terms + 1) || same_way < kFewest || aside.norm() > kMostAside) return 0;
    const TermVector solution = fit_terms(terms.leftCols(n), height.head(n));
    const double gap = solution(num_terms);
    const double left = (height.head(n) - solution.transpose().lazyProduct(terms.leftCols(n))).norm() /
                        std::sqrt(static_cast<double>(n - num_terms - 1));
    if (std::abs(gap) < kLeastGap * left) return 0;
    const auto depth = [&](const Direction& place) {
      const double middle = solution.head(num_terms).dot(quadric_terms(place));
      const Direction x = points_.col(i) + radius * (middle * normal + tangents.lazyProduct(place));
      double f = 0;
      evaluator_->evaluate({.n = 1, .x = x.data(), .value = &f});
      return gap > 0 ? -f : f;
    };
    bool bridged = depth(Direction::Zero(num_tangents)) < kLeastDepth * std::abs(gap) * radius;
    for (Index j = 1; j < same_way && !bridged; ++j) bridged = depth(0.5 * places.col(j)) < 0;
    return bridged ? std::abs(gap) * radius : 0;
  }

 private:
  const Points& points_;
  const Points& normals_;
  const KdTree& tree_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<Neighbour> found_;
};

MergedSheets find(const Points& points, const Points& normals, const KdTree& tree, const ImplicitFunction& function,
                  const Context& context) {
  const Index num_probes = std::min(points.cols(), kMostProbes);
  const auto sample = [&](Index probe) { return probe * points.cols() / num_probes; };
  std::vector<double> gap(static_cast<std::size_t>(num_probes));
  parallel_for(context, 0, num_probes, kGrain, [&](Index first, Index last) {
    Probe probe(points, normals, tree, function);
    for (Index j = first; j < last; ++j) gap[static_cast<std::size_t>(j)] = probe(sample(j));
  });
  MergedSheets merged;
  for (Index j = 0; j < num_probes; ++j) {
    const double here = gap[static_cast<std::size_t>(j)];
    if (here == 0) continue;
    if (merged.count++ == 0) merged.at = sample(j);
    merged.gap += here;
  }
  if (static_cast<double>(merged.count) <= kFewOfAll * static_cast<double>(num_probes)) return {};
  merged.gap /= static_cast<double>(merged.count);
  merged.count = merged.count * points.cols() / num_probes;
  return merged;
}

}  // namespace

MergedSheets find_bridged_gap(const Points& points, const Points& normals, const KdTree& tree,
                              const ImplicitFunction& function, const Context& context) {
  if (points.cols() < 2 * kNearest || points.rows() > 3) return {};
  return find(points, normals, tree, function, context);
}

}  // namespace taut::detail
