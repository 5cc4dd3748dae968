#include "surface/normals/sheet_split.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"
#include "surface/normals/sample_quadric.hpp"

// Around a sample, h the height over a plane and t the place in it, two sheets that run side by side are
//   h = a + b.t + t^T C t        and        h = a + b.t + t^T C t + gap,
// one quadric moved along the normal: bent plates of little thickness are that, too. Which sample lies on which is
// found in turns, as in k-means: least squares for a, b, C and the gap, then each sample to the sheet that it is nearer
// to; the first guess cuts the samples where their heights leave a gap. Samples of one noisy sheet can be parted in two
// as well: gap / (what the two sheets leave, standard deviation), the clarity, tells.
//
// Clarity measured on 21 x 21 samples, on a grid or strewn at random, the median of nine neighbours (5 % .. 99 %):
//   one sheet with noise of 0.02 to 0.3 spacings                      3.1 .. 5.2
//   one sheet bent to a radius of 5 spacings                          4.5 .. 7.7
//   two sheets 0.1 to 1.5 spacings apart, noise of 0.05 gaps          15 .. 33
//   the same, noise of 0.15 gaps                                      5.0 .. 12
// A sheet sampled in rows can be parted into rows, each with a height of its own, as well as any two sheets. But then
// its place tells which of them a sample belongs to; on two sheets it does not.

namespace taut::detail {
namespace {

/// The median clarity around a sample that makes it one of two sheets.
constexpr double kClear = 8;
/// Its own clarity then; random gaps in the samples make it waver.
constexpr double kClearItself = 6;
constexpr Index kVoters = 9;
/// How well the place may tell the sheet (the coefficient of determination): of 24 samples on two sheets 0.6 by chance.
constexpr double kMostByPlace = 0.92;
constexpr int kFewestOnSheet = 4;
constexpr int kMostPasses = 4;
/// Where fewer of the probes see two sheets, none are looked for: noise alone makes none of 1,000 see them.
constexpr Index kMaxProbes = 1000;
constexpr double kFewProbes = 0.01;
constexpr Index kGrain = 64;

class Splitter {
 public:
  static constexpr int kNearest = SheetSplit::kNearest;

  struct Split {
    double clarity = 0;
    std::uint32_t across = 0;  // bit j: the j-th nearest lies on the other sheet than the sample itself, the nearest
    Direction normal;
  };

  Splitter(const Points& points, const KdTree& tree)
      : points_(points),
        tree_(tree),
        num_tangents_(points.rows() - 1),
        num_terms_(num_quadric_terms(num_tangents_)),
        u_(points.rows(), kNearest),
        terms_(num_terms_ + 1, kNearest) {}

  /// The clearest way to part the nearest of sample i, over planes through the nearest 24, 12 and 6: of two sheets that
  /// are farther apart the last are on one.
  Split operator()(Index i) {
    tree_.nearest(points_.col(i).data(), kNearest, found_);
    n_ = static_cast<int>(found_.size());
    Split best;
    const double radius = std::sqrt(found_.back().squared_distance);
    if (n_ < kNearest || !(radius > 0)) return best;
    for (int j = 0; j < n_; ++j)
      u_.col(j) = (points_.col(found_[static_cast<std::size_t>(j)].index) - points_.col(i)) / radius;
    for (const int count : {kNearest, kNearest / 2, kNearest / 4}) {
      const Split split = over_plane_of(count);
      if (split.clarity > best.clarity) best = split;
    }
    return best;
  }
  [[nodiscard]] const std::vector<Neighbour>& nearest() const { return found_; }

 private:
  /// Over the plane of least spread of the nearest `count`.
  Split over_plane_of(Index count) {
    axes_ = axes_by_spread(u_.leftCols(count));
    const Around local = axes_.transpose().lazyProduct(u_);
    height_ = local.row(0);
    place_ = local.bottomRows(num_tangents_);
    for (Index j = 0; j < kNearest; ++j) terms_.col(j).head(num_terms_) = quadric_terms(place_.col(j));
    return widest_gaps();
  }

  Split widest_gaps() {
    constexpr int kTried = 2;
    std::array<int, kNearest> order{};
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return height_(a) < height_(b); });
    std::vector<std::pair<double, int>> gaps;
    for (int j = kFewestOnSheet; j <= kNearest - kFewestOnSheet; ++j) {
      gaps.emplace_back(height_(order[static_cast<std::size_t>(j - 1)]) - height_(order[static_cast<std::size_t>(j)]),
                        j);
    }
    std::sort(gaps.begin(), gaps.end());
    Split best;
    for (int g = 0; g < kTried; ++g) {
      AroundRow upper = AroundRow::Zero(kNearest);
      for (int j = gaps[static_cast<std::size_t>(g)].second; j < kNearest; ++j) {
        upper(order[static_cast<std::size_t>(j)]) = 1;
      }
      const Split split = in_turns(upper);
      if (split.clarity > best.clarity) best = split;
    }
    return best;
  }

  /// `upper`: 1 for the samples on the upper sheet, at first.
  Split in_turns(AroundRow upper) {
    Split split;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      const double count = upper.sum();
      if (count < kFewestOnSheet || count > kNearest - kFewestOnSheet) return {};
      terms_.row(num_terms_) = upper;
      const TermVector solution = fit_terms(terms_, height_);
      AroundRow rest = height_;
      for (Index j = 0; j < kNearest; ++j) rest(j) -= solution.dot(terms_.col(j));
      const double gap = solution(num_terms_);
      const double left = std::sqrt(rest.squaredNorm() / static_cast<double>(kNearest - num_terms_ - 1));
      split.clarity = gap > 0 ? gap / std::max(left, kRidge) : 0;
      split.normal = axes_.col(0);
      for (Index a = 0; a < num_tangents_; ++a) split.normal -= solution(1 + a) * axes_.col(1 + a);
      // The height of each over the lower sheet.
      const AroundRow next = ((rest + gap * upper).array() > 0.5 * gap).template cast<double>();
      if (next == upper) break;
      upper = next;
    }
    if (split.clarity < kClearItself || told_by_place(upper)) return {};
    split.normal.normalize();
    for (int j = 0; j < kNearest; ++j) {
      if (upper(j) != upper(0)) split.across |= 1U << static_cast<unsigned>(j);
    }
    return split;
  }

  /// By polynomials of degree four in the place: rows of samples on a bent sheet differ by their fourth power.
  [[nodiscard]] bool told_by_place(const AroundRow& upper) const {
    const bool flat = num_tangents_ == 1;
    AroundTerms powers(flat ? 5 : 15, kNearest);
    for (Index j = 0; j < kNearest; ++j) {
      Index row = 0;
      double first = 1;
      for (int a = 0; a <= 4; ++a, first *= place_(0, j)) {
        double product = first;
        for (int b = 0; b <= (flat ? 0 : 4 - a); ++b, product *= place_(num_tangents_ - 1, j)) {
          powers(row++, j) = product;
        }
      }
    }
    const TermVector solution = fit_terms(powers, upper);
    const double open = (upper - solution.transpose().lazyProduct(powers)).squaredNorm();
    const double all = (upper.array() - upper.mean()).matrix().squaredNorm();
    return open < (1 - kMostByPlace) * all;
  }

  const Points& points_;
  const KdTree& tree_;
  std::vector<Neighbour> found_;
  int n_ = 0;
  Index num_tangents_;
  Index num_terms_;  // of the quadric
  Around u_;         // the nearest, seen from the sample, the farthest at 1
  Axes axes_;        // the first across the sheet
  Around place_;     // along the others
  AroundRow height_;
  AroundTerms terms_;  // the quadric's, then whether a sample lies on the upper sheet
};

bool worth_while(const Points& points, const KdTree& tree) {
  const Index num_probes = std::min(points.cols(), kMaxProbes);
  Splitter split(points, tree);
  Index clear = 0;
  for (Index probe = 0; probe < num_probes; ++probe) {
    if (split(probe * points.cols() / num_probes).clarity >= kClear) ++clear;
  }
  return static_cast<double>(clear) > kFewProbes * static_cast<double>(num_probes);
}

}  // namespace

void SheetSplit::find(const Points& points, const KdTree& tree, const Context& context) {
  if (!worth_while(points, tree)) return;
  const Index n = points.cols();
  std::vector<Splitter::Split> split(static_cast<std::size_t>(n));
  parallel_for(context, 0, n, kGrain, [&](Index first, Index last) {
    Splitter splitter(points, tree);
    for (Index i = first; i < last; ++i) split[static_cast<std::size_t>(i)] = splitter(i);
  });
  std::vector<Neighbour> near;
  std::vector<double> votes;
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (split[at].clarity < kClearItself) continue;
    tree.nearest(points.col(i).data(), kNearest, near);
    votes.clear();
    for (Index j = 0; j < kVoters; ++j) {
      votes.push_back(split[static_cast<std::size_t>(near[static_cast<std::size_t>(j)].index)].clarity);
    }
    std::nth_element(votes.begin(), votes.begin() + kVoters / 2, votes.end());
    if (votes[kVoters / 2] < kClear) continue;
    Found found;
    for (std::size_t j = 0; j < near.size(); ++j) found.near[j] = static_cast<std::uint32_t>(near[j].index);
    found.across = split[at].across;
    found.opposite = found.near[static_cast<std::size_t>(std::countr_zero(found.across))];
    found.normal = split[at].normal;
    slot_[at] = static_cast<std::int32_t>(found_.size());
    found_.push_back(std::move(found));
  }
}

SheetSplit::SheetSplit(const Points& points, const KdTree& tree, const Context& context)
    : slot_(static_cast<std::size_t>(points.cols()), -1) {
  if (points.cols() < 2 * kNearest) return;
  if (points.rows() == 2 || points.rows() == 3) find(points, tree, context);
}

std::vector<Index> SheetSplit::beside(Index i) const {
  const Found& found = at(i);
  std::vector<Index> samples;
  for (std::size_t k = 1; k < found.near.size(); ++k) {
    if ((found.across >> k & 1U) == 0) samples.push_back(static_cast<Index>(found.near[k]));
  }
  return samples;
}

SheetSplit::Relation SheetSplit::as_seen_from(std::uint32_t i, std::uint32_t j) const {
  if (!is_split(i)) return Relation::unknown;
  const Found& found = at(i);
  for (std::size_t k = 0; k < found.near.size(); ++k) {
    if (found.near[k] == j) return (found.across >> k & 1U) != 0 ? Relation::across : Relation::within;
  }
  return Relation::unknown;
}

SheetSplit::Relation SheetSplit::relation(NeighbourGraph::Edge edge) const {
  const Relation from_a = as_seen_from(edge.a, edge.b);
  const Relation from_b = as_seen_from(edge.b, edge.a);
  if (from_a == from_b) return from_a;
  if (from_a != Relation::unknown && from_b != Relation::unknown) return Relation::unknown;
  const Relation seen = from_a == Relation::unknown ? from_b : from_a;
  return seen == Relation::within ? Relation::perhaps_within : Relation::perhaps_across;
}

}  // namespace taut::detail
