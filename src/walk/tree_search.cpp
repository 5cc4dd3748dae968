#include "walk/tree_search.hpp"

#include <algorithm>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "core/random.hpp"

namespace taut::detail {
namespace {

/// Steps a tree takes towards a random target at a time.
constexpr Index kStride = 24;
/// Every so many rounds the target is the other end itself.
constexpr int kGoalEvery = 4;
/// Random targets lie within this many distances of the two points around their middle.
constexpr double kSpread = 2;
constexpr int kShortcuts = 60;

struct Tree {
  std::vector<Foothold> nodes;
  std::vector<std::size_t> parent;

  explicit Tree(Foothold root) : nodes{std::move(root)}, parent{0} {}

  [[nodiscard]] std::size_t nearest(const Vector& x) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double square = (nodes[i].point - x).squaredNorm();
      if (square < least) {
        least = square;
        best = i;
      }
    }
    return best;
  }
  /// Appends a chain of steps that began at node `from`. Returns its last node.
  std::size_t add(std::size_t from, std::vector<Foothold>& steps) {
    for (Foothold& step : steps) {
      nodes.push_back(std::move(step));
      parent.push_back(from);
      from = nodes.size() - 1;
    }
    steps.clear();
    return from;
  }
  /// Points from node i back to the root.
  [[nodiscard]] std::vector<Vector> back_from(std::size_t i) const {
    std::vector<Vector> line = {nodes[i].point};
    for (; i != 0; i = parent[i]) line.push_back(nodes[parent[i]].point);
    return line;
  }
};

double length_of(const std::vector<Vector>& line, std::size_t i, std::size_t j) {
  double length = 0;
  for (; i < j; ++i) length += (line[i + 1] - line[i]).norm();
  return length;
}

/// Replaces parts of the line by straight walks that are shorter.
void straighten(SurfaceWalker& walker, std::vector<Vector>& line, std::mt19937_64& random) {
  for (int i = 0; i < kShortcuts && line.size() > 2; ++i) {
    std::size_t a = random() % line.size();
    std::size_t b = random() % line.size();
    if (a > b) std::swap(a, b);
    if (b < a + 2) continue;
    const Points walk = walker.walk(line[a], line[b]);
    if (walk.cols() < 2) continue;
    std::vector<Vector> shorter;
    for (Index j = 0; j < walk.cols(); ++j) shorter.emplace_back(walk.col(j));
    if (length_of(shorter, 0, shorter.size() - 1) >= length_of(line, a, b)) continue;
    const auto begin = line.begin() + static_cast<std::ptrdiff_t>(a);
    line.erase(begin, line.begin() + static_cast<std::ptrdiff_t>(b) + 1);
    line.insert(line.begin() + static_cast<std::ptrdiff_t>(a), shorter.begin(), shorter.end());
  }
}

}  // namespace

Points search_by_trees(SurfaceWalker& walker, const Vector& p, const Vector& q, const TreeSearchOptions& options,
                       const Context& context) {
  Foothold start;
  Foothold end;
  if (!walker.stand(p, walker.step(), start) || !walker.stand(q, walker.step(), end)) return Points(p.size(), 0);
  std::mt19937_64 random(options.seed);
  const Vector centre = (p + q) / 2;
  const double radius = kSpread * (q - p).norm();
  Tree from_p(start);
  Tree from_q(end);
  Tree* grows = &from_p;
  Tree* meets = &from_q;
  std::vector<Foothold> steps;
  const Index first = walker.num_steps();
  for (int round = 0; walker.num_steps() - first < options.max_steps; ++round) {
    context.check_cancelled();
    const bool goal = round % kGoalEvery == kGoalEvery - 1;
    const Vector target = goal ? meets->nodes.front().point
                               : Vector(centre + radius * random_share(random) * random_direction(p.size(), random));
    const std::size_t near = grows->nearest(target);
    (void)walker.walk(grows->nodes[near], target, kStride, steps);
    const std::size_t tip = grows->add(near, steps);
    const Vector aim = grows->nodes[tip].point;
    const std::size_t other = meets->nearest(aim);
    const bool met = walker.walk(meets->nodes[other], aim, options.max_steps / 10, steps);
    const std::size_t touch = meets->add(other, steps);
    if (met) {
      std::vector<Vector> line = grows->back_from(tip);
      const std::vector<Vector> rest = meets->back_from(touch);
      std::reverse(line.begin(), line.end());
      line.insert(line.end(), rest.begin(), rest.end());
      if (grows != &from_p) std::reverse(line.begin(), line.end());
      straighten(walker, line, random);
      Points path(p.size(), static_cast<Index>(line.size()));
      for (std::size_t j = 0; j < line.size(); ++j) path.col(static_cast<Index>(j)) = line[j];
      path.col(0) = p;
      path.rightCols<1>() = q;
      return path;
    }
    std::swap(grows, meets);
  }
  return Points(p.size(), 0);
}

}  // namespace taut::detail
