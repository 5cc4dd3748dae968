#include "surface/normals/given_normals.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "surface/normals/face_normals.hpp"
#include "surface/normals/orientation.hpp"
#include "surface/normals/spread_normals.hpp"

namespace taut::detail {
namespace {

Points merged_normals(const PointCloud& cloud, const MergedPoints& merged) {
  Points unit = cloud.normals;
  normalise_columns(unit);
  Points normals = Points::Zero(merged.points.rows(), merged.points.cols());
  for (Index i = 0; i < unit.cols(); ++i) normals.col(merged.merged_to[static_cast<std::size_t>(i)]) += unit.col(i);
  for (Index i = 0; i < normals.cols(); ++i) {
    // What is left of opposite normals at one point is rounding.
    if (normals.col(i).norm() < 1e-6) normals.col(i).setZero();
  }
  normalise_columns(normals);
  return normals;
}

/// Do the normals stand on the sheet? Of a good scan's nearly all do within 60 degrees of the direction of least spread
/// of the neighbours; of a constant one's on a sphere half.
bool stand_on_sheet(const Points& points, const Points& normals, const KdTree& tree, Index neighbours,
                    const Context& context) {
  constexpr Index kMaxProbes = 1000;
  constexpr double kLeastCosine = 0.5;
  constexpr double kMostAskew = 0.3;
  const Index num_probes = std::min(points.cols(), kMaxProbes);
  std::vector<Index> at;
  for (Index probe = 0; probe < num_probes; ++probe) {
    const Index i = probe * points.cols() / num_probes;
    if (!normals.col(i).isZero(0)) at.push_back(i);
  }
  if (at.empty()) return true;
  const Points spread =
      least_spread(points, tree, at, neighbours_for_noise(points, tree, neighbours, context), context);
  Index askew = 0;
  for (Index i = 0; i < spread.cols(); ++i) {
    const double cosine = spread.col(i).dot(normals.col(at[static_cast<std::size_t>(i)]));
    if (std::abs(cosine) < kLeastCosine) ++askew;
  }
  return static_cast<double>(askew) <= kMostAskew * static_cast<double>(at.size());
}

/// Edges within the sheet whose ends' normals are alike but for the sign, and how many of them disagree in sign.
struct Signs {
  Index sure = 0;
  Index disagree = 0;
};

Signs compare_signs(const Points& points, const Points& normals, const NeighbourGraph& graph) {
  constexpr double kAlike = 0.8;   // cosine
  constexpr double kWithin = 0.5;  // sum of two cosines
  Signs signs;
  for (const NeighbourGraph::Edge& edge : graph.edges()) {
    const EdgeComparison compared = compare_normals(points, normals, edge);
    if (std::abs(compared.agreement) < kAlike || compared.along > kWithin) continue;
    ++signs.sure;
    if (compared.agreement < 0) ++signs.disagree;
  }
  return signs;
}

/// Gives each piece the side that most of its normals had. Returns how many were turned, and of pieces without a clear
/// majority the numbers in `open`.
Index keep_majority(const Points& given, const std::vector<Index>& piece, Points& oriented, std::vector<bool>& open) {
  constexpr double kClear = 0.55;
  struct Votes {
    Index kept = 0;
    Index all = 0;
  };
  std::map<Index, Votes> votes;
  for (Index i = 0; i < given.cols(); ++i) {
    if (given.col(i).isZero(0)) continue;
    Votes& vote = votes[piece[static_cast<std::size_t>(i)]];
    ++vote.all;
    if (given.col(i).dot(oriented.col(i)) > 0) ++vote.kept;
  }
  Index turned = 0;
  for (Index i = 0; i < given.cols(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Votes& vote = votes[piece[at]];
    const double share = static_cast<double>(vote.kept) / static_cast<double>(std::max<Index>(vote.all, 1));
    open[at] = std::max(share, 1 - share) < kClear;
    if (share < 0.5) oriented.col(i) *= -1;
    if (given.col(i).dot(oriented.col(i)) < 0) ++turned;
  }
  return turned;
}

}  // namespace

std::optional<Points> checked_normals(const PointCloud& cloud, const MergedPoints& merged, const KdTree& tree,
                                      Index neighbours, const Context& context) {
  const Points& points = merged.points;
  Points normals = merged_normals(cloud, merged);
  if (normals.isZero(0)) return std::nullopt;
  if (!stand_on_sheet(points, normals, tree, neighbours, context)) {
    context.tell("the normals in the file do not stand on the sheet that the points make: they are estimated instead");
    return std::nullopt;
  }
  const NeighbourGraph graph(points, tree, neighbours, context);
  const Signs before = compare_signs(points, normals, graph);
  // Creases and thin parts make a few edges disagree although all is well.
  constexpr double kFew = 0.002;
  if (static_cast<double>(before.disagree) <= kFew * static_cast<double>(before.sure)) return normals;
  Points oriented = normals;
  const std::vector<Index> piece = orient_along_forest(points, graph, oriented);
  const Signs after = compare_signs(points, oriented, graph);
  constexpr double kBetter = 0.5;
  if (static_cast<double>(after.disagree) > kBetter * static_cast<double>(before.disagree)) return normals;
  std::vector<bool> open(static_cast<std::size_t>(points.cols()), false);
  const Index turned = keep_majority(normals, piece, oriented, open);
  if (std::find(open.begin(), open.end(), true) != open.end()) {
    Points outwards = oriented;
    turn_outwards(points, local_spacing(points, tree, context), piece, outwards);
    for (Index i = 0; i < points.cols(); ++i) {
      if (open[static_cast<std::size_t>(i)]) oriented.col(i) = outwards.col(i);
    }
    context.tell("the normals in the file point to either side at random: their sides are estimated");
  } else if (turned > 0) {
    context.tell(std::to_string(turned) + (turned == 1 ? " normal points" : " normals point") +
                 " to the other side than those around: turned");
  }
  return oriented;
}

}  // namespace taut::detail
