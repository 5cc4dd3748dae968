#include "walk/sample_graph.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace taut::detail {
namespace {

constexpr std::size_t kNeighbours = 12;

using Edge = std::pair<double, Index>;  // length, node

/// The nearest columns of `points` to column i that can be walked to.
std::vector<Edge> neighbours(SurfaceWalker& walker, const Points& points, Index i) {
  std::vector<Edge> near;
  near.reserve(static_cast<std::size_t>(points.cols()));
  for (Index j = 0; j < points.cols(); ++j) {
    if (j != i) near.emplace_back((points.col(j) - points.col(i)).norm(), j);
  }
  const std::size_t kept = std::min(kNeighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end());
  near.resize(kept);
  std::erase_if(near, [&](const Edge& edge) {
    return walker.walk(Vector(points.col(i)), Vector(points.col(edge.second))).cols() < 2;
  });
  return near;
}

}  // namespace

// Dijkstra's algorithm from q, so that the ancestors of p are the way. A node's neighbours are looked for when it is
// settled; those of p are looked for first, since p may be near to nodes that have nearer neighbours than p.
Points search_by_samples(SurfaceWalker& walker, const Vector& p, const Vector& q, const PointsIn& samples,
                         const Context& context) {
  Points points(p.size(), samples.cols() + 2);
  points.col(0) = p;
  points.col(1) = q;
  Index count = 2;
  Foothold foothold;
  for (Index j = 0; j < samples.cols(); ++j) {
    if (!samples.col(j).allFinite()) continue;
    if (!walker.stand(samples.col(j), std::numeric_limits<double>::infinity(), foothold)) continue;
    if (foothold.point != p && foothold.point != q) points.col(count++) = foothold.point;
  }
  points.conservativeResize(Eigen::NoChange, count);

  std::vector<double> distance(static_cast<std::size_t>(count), std::numeric_limits<double>::infinity());
  std::vector<Index> next(static_cast<std::size_t>(count), -1);
  std::vector<bool> settled(static_cast<std::size_t>(count), false);
  const std::vector<Edge> at_p = neighbours(walker, points, 0);
  std::priority_queue<Edge, std::vector<Edge>, std::greater<>> queue;
  distance[1] = 0;
  queue.emplace(0, 1);
  const auto relax = [&](Index from, double length, Index to) {
    const double through = distance[static_cast<std::size_t>(from)] + length;
    if (through >= distance[static_cast<std::size_t>(to)]) return;
    distance[static_cast<std::size_t>(to)] = through;
    next[static_cast<std::size_t>(to)] = from;
    queue.emplace(through, to);
  };
  while (!queue.empty() && !settled[0]) {
    context.check_cancelled();
    const Index i = queue.top().second;
    queue.pop();
    if (settled[static_cast<std::size_t>(i)]) continue;
    settled[static_cast<std::size_t>(i)] = true;
    if (i == 0) break;
    for (const auto& [length, j] : neighbours(walker, points, i)) relax(i, length, j);
    for (const auto& [length, j] : at_p) {
      if (j == i) relax(i, length, 0);
    }
  }
  if (!settled[0]) return Points(p.size(), 0);

  std::vector<Vector> line = {p};
  for (Index i = 0; i != 1; i = next[static_cast<std::size_t>(i)]) {
    const Index to = next[static_cast<std::size_t>(i)];
    Points walk = walker.walk(Vector(points.col(i)), Vector(points.col(to)));
    if (walk.cols() < 2) walk = walker.walk(Vector(points.col(to)), Vector(points.col(i))).rowwise().reverse().eval();
    for (Index j = 1; j < walk.cols(); ++j) line.emplace_back(walk.col(j));
  }
  Points path(p.size(), static_cast<Index>(line.size()));
  for (std::size_t j = 0; j < line.size(); ++j) path.col(static_cast<Index>(j)) = line[j];
  return path;
}

}  // namespace taut::detail
