#include "surface/normals/bridged_gap.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/parallel.hpp"

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

template <int D>
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
    const Eigen::HouseholderQR<Direction> frame(normal);
    const Square axes = frame.householderQ();
    const double radius = std::sqrt(found_.back().squared_distance);
    if (!(radius > 0)) return 0;
    Eigen::Matrix<double, kTerms + 1, Eigen::Dynamic, 0, kTerms + 1, kNearest> terms(kTerms + 1, kNearest);
    Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kNearest> height(kNearest);
    Eigen::Matrix<double, D - 1, Eigen::Dynamic, D == 2 ? Eigen::RowMajor : Eigen::ColMajor, D - 1, kNearest> places(
        D - 1, kNearest);
    Index n = 0;
    Index same_way = 0;
    Place aside = Place::Zero();
    for (const Neighbour& near : found_) {
      const double cosine = normals_.col(near.index).dot(normal);
      if (std::abs(cosine) < kSameWay) continue;  // of a rim
      const Direction u = (points_.col(near.index) - points_.col(i)) / radius;
      const Place place = axes.template rightCols<D - 1>().transpose() * u;
      terms.col(n) << terms_at(place), (cosine > 0 ? 0.5 : -0.5);
      height(n++) = normal.dot(u);
      if (cosine > 0) {
        places.col(same_way++) = place;
      } else {
        aside += place / static_cast<double>(other_way);
      }
    }
    if (n < 2 * (kTerms + 1) || same_way < kFewest || aside.norm() > kMostAside) return 0;
    Eigen::Matrix<double, kTerms + 1, kTerms + 1> equations = terms.leftCols(n) * terms.leftCols(n).transpose();
    equations.diagonal().array() += kRidge * static_cast<double>(n);
    const Eigen::Matrix<double, kTerms + 1, 1> solution =
        equations.ldlt().solve(terms.leftCols(n) * height.head(n).transpose());
    const double gap = solution(kTerms);
    const double left = (height.head(n) - solution.transpose() * terms.leftCols(n)).norm() /
                        std::sqrt(static_cast<double>(n - kTerms - 1));
    if (std::abs(gap) < kLeastGap * left) return 0;
    const auto depth = [&](const Place& place) {
      const double middle = solution.template head<kTerms>().dot(terms_at(place));
      const Direction x = points_.col(i) + radius * (middle * normal + axes.template rightCols<D - 1>() * place);
      double f = 0;
      evaluator_->evaluate({.n = 1, .x = x.data(), .value = &f});
      return gap > 0 ? -f : f;
    };
    bool bridged = depth(Place::Zero()) < kLeastDepth * std::abs(gap) * radius;
    for (Index j = 1; j < same_way && !bridged; ++j) bridged = depth(0.5 * places.col(j)) < 0;
    return bridged ? std::abs(gap) * radius : 0;
  }

 private:
  static constexpr int kTerms = 1 + (D - 1) + (D - 1) * D / 2;
  static constexpr double kRidge = 1e-10;  // where samples in rows leave a term open
  using Direction = Eigen::Matrix<double, D, 1>;
  using Square = Eigen::Matrix<double, D, D>;
  using Place = Eigen::Matrix<double, D - 1, 1>;

  static Eigen::Matrix<double, kTerms, 1> terms_at(const Place& place) {
    Eigen::Matrix<double, kTerms, 1> terms;
    terms(0) = 1;
    int row = 1;
    for (int a = 0; a < D - 1; ++a) terms(row++) = place(a);
    for (int a = 0; a < D - 1; ++a) {
      for (int b = 0; b <= a; ++b) terms(row++) = place(a) * place(b);
    }
    return terms;
  }

  const Points& points_;
  const Points& normals_;
  const KdTree& tree_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<Neighbour> found_;
};

template <int D>
MergedSheets find(const Points& points, const Points& normals, const KdTree& tree, const ImplicitFunction& function,
                  const Context& context) {
  const Index num_probes = std::min(points.cols(), kMostProbes);
  const auto sample = [&](Index probe) { return probe * points.cols() / num_probes; };
  std::vector<double> gap(static_cast<std::size_t>(num_probes));
  parallel_for(context, 0, num_probes, kGrain, [&](Index first, Index last) {
    Probe<D> probe(points, normals, tree, function);
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
  if (points.cols() < 2 * kNearest) return {};
  if (points.rows() == 2) return find<2>(points, normals, tree, function, context);
  if (points.rows() == 3) return find<3>(points, normals, tree, function, context);
  return {};
}

}  // namespace taut::detail
