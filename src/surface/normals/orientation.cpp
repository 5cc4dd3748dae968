#include "surface/normals/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "core/disjoint_sets.hpp"

namespace taut::detail {
namespace {

struct RankedEdge {
  double weight;
  NeighbourGraph::Edge edge;
  bool flips;  // the two ends' present signs disagree

  bool operator<(const RankedEdge& other) const {
    if (weight != other.weight) return weight < other.weight;
    return std::pair(edge.a, edge.b) < std::pair(other.edge.a, other.edge.b);
  }
};

/// The forest's edges by point: those of point i are links[first[i]] .. links[first[i + 1]].
struct Forest {
  struct Link {
    std::uint32_t to;
    bool flips;
  };
  std::vector<std::uint32_t> first;
  std::vector<Link> links;
};

Forest make_forest(Index num_points, const std::vector<RankedEdge>& edges) {
  const auto n = static_cast<std::size_t>(num_points);
  Forest forest{std::vector<std::uint32_t>(n + 1, 0), std::vector<Forest::Link>(2 * edges.size())};
  for (const RankedEdge& ranked : edges) {
    ++forest.first[ranked.edge.a + 1];
    ++forest.first[ranked.edge.b + 1];
  }
  for (std::size_t i = 0; i < n; ++i) forest.first[i + 1] += forest.first[i];
  std::vector<std::uint32_t> next = forest.first;
  for (const RankedEdge& ranked : edges) {
    forest.links[next[ranked.edge.a]++] = {ranked.edge.b, ranked.flips};
    forest.links[next[ranked.edge.b]++] = {ranked.edge.a, ranked.flips};
  }
  return forest;
}

}  // namespace

EdgeComparison compare_normals(const Points& points, const Points& normals, NeighbourGraph::Edge edge) {
  const Index a = edge.a;
  const Index b = edge.b;
  double squared = 0;
  double along_a = 0;
  double along_b = 0;
  double dot = 0;
  for (Index axis = 0; axis < points.rows(); ++axis) {
    const double e = points(axis, b) - points(axis, a);
    squared += e * e;
    along_a += e * normals(axis, a);
    along_b += e * normals(axis, b);
    dot += normals(axis, a) * normals(axis, b);
  }
  const double length = std::sqrt(squared);
  along_a /= length;
  along_b /= length;
  return {dot - 2 * along_a * along_b, std::abs(along_a) + std::abs(along_b)};
}

std::vector<Index> orient_along_forest(const Points& points, const NeighbourGraph& graph, Points& normals) {
  const Index n = points.cols();
  std::vector<RankedEdge> edges;
  edges.reserve(graph.edges().size());
  for (const NeighbourGraph::Edge& edge : graph.edges()) {
    const EdgeComparison compared = compare_normals(points, normals, edge);
    edges.push_back({1 - std::abs(compared.agreement) + compared.along, edge, compared.agreement < 0});
  }
  std::sort(edges.begin(), edges.end());
  DisjointSets joined(static_cast<std::size_t>(n));
  std::erase_if(edges, [&](const RankedEdge& ranked) { return !joined.unite(ranked.edge.a, ranked.edge.b); });
  const Forest forest = make_forest(n, edges);
  std::vector<Index> piece(static_cast<std::size_t>(n), -1);
  std::vector<std::pair<std::uint32_t, bool>> stack;
  for (Index root = 0; root < n; ++root) {
    if (piece[static_cast<std::size_t>(root)] >= 0) continue;
    stack.emplace_back(static_cast<std::uint32_t>(root), false);
    while (!stack.empty()) {
      const auto [i, flipped] = stack.back();
      stack.pop_back();
      piece[i] = root;
      if (flipped) normals.col(i) *= -1;
      for (std::uint32_t at = forest.first[i]; at < forest.first[i + 1]; ++at) {
        const Forest::Link& link = forest.links[at];
        if (piece[link.to] < 0) stack.emplace_back(link.to, flipped != link.flips);
      }
    }
  }
  return piece;
}

void turn_outwards(const Points& points, const Vector& spacing, const std::vector<Index>& piece, Points& normals) {
  std::map<Index, std::vector<Index>> members;
  for (Index i = 0; i < points.cols(); ++i) members[piece[static_cast<std::size_t>(i)]].push_back(i);
  for (const auto& [root, points_of_piece] : members) {
    const Vector centre = points(Eigen::all, points_of_piece).rowwise().mean();
    double flux = 0;
    for (const Index i : points_of_piece) {
      const double area = std::pow(spacing(i), static_cast<double>(points.rows() - 1));
      flux += area * (points.col(i) - centre).dot(normals.col(i));
    }
    if (flux >= 0) continue;
    for (const Index i : points_of_piece) normals.col(i) *= -1;
  }
}

}  // namespace taut::detail
