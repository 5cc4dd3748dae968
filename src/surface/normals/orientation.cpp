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
  bool flips;             // the two ends' present signs disagree
  bool opposite = false;  // the ends lie on two sheets that face away from each other

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

RankedEdge ranked(const Points& points, const Points& normals, NeighbourGraph::Edge edge) {
  const EdgeComparison compared = compare_normals(points, normals, edge);
  return {1 - std::abs(compared.agreement) + compared.along, edge, compared.agreement < 0};
}

/// Makes signs agree along the forest that the edges make, taken in their order. Returns the piece of each point.
std::vector<Index> orient(std::vector<RankedEdge> edges, Points& normals) {
  const Index n = normals.cols();
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

struct Voter {
  NeighbourGraph::Edge edge;
  bool across = false;
};

/// For each pair of sheets an edge between them that flips as most do: those with the greatest majority first.
std::vector<RankedEdge> majority_votes(const std::vector<Voter>& voters, const std::vector<Index>& sheet,
                                       const Points& normals) {
  struct Votes {
    Index flip = 0;
    Index keep = 0;
    NeighbourGraph::Edge first_flip;
    NeighbourGraph::Edge first_keep;
  };
  std::map<std::pair<Index, Index>, Votes> votes;
  for (const auto& [edge, across] : voters) {
    const auto pair = std::minmax(sheet[edge.a], sheet[edge.b]);
    if (pair.first == pair.second) continue;
    Votes& vote = votes[pair];
    if ((normals.col(edge.a).dot(normals.col(edge.b)) > 0) == across) {
      if (vote.flip++ == 0) vote.first_flip = edge;
    } else if (vote.keep++ == 0) {
      vote.first_keep = edge;
    }
  }
  std::vector<RankedEdge> majority;
  for (const auto& [pair, vote] : votes) {
    const auto lead = static_cast<double>(vote.flip - vote.keep);
    majority.push_back({-std::abs(lead), lead > 0 ? vote.first_flip : vote.first_keep, lead > 0, true});
  }
  std::sort(majority.begin(), majority.end());
  return majority;
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
  std::vector<RankedEdge> edges;
  edges.reserve(graph.edges().size());
  for (const NeighbourGraph::Edge& edge : graph.edges()) edges.push_back(ranked(points, normals, edge));
  std::sort(edges.begin(), edges.end());
  return orient(std::move(edges), normals);
}

// Within one sheet as above. Then sheet by sheet: opposite sheets face away from each other, and all edges between two
// of them vote, since one that was taken for such by mistake would turn a whole face. What no edge is sure of comes
// last.
// Edges that are said to lie within a sheet and yet lead off it are mistakes, and one of them would join two faces.
std::vector<Index> orient_sheets(const Points& points, const NeighbourGraph& graph, const SheetSplit& split,
                                 Points& normals) {
  constexpr double kWithinSheet = 0.7;  // the weight of edges, some 0.1 on clean sheets, 0.5 on noisy and bent ones
  std::vector<RankedEdge> within;
  std::vector<Voter> between;
  std::vector<NeighbourGraph::Edge> unknown;
  for (const NeighbourGraph::Edge& edge : graph.edges()) {
    switch (split.relation(edge)) {
      case SheetSplit::Relation::within: {
        const RankedEdge along_sheet = ranked(points, normals, edge);
        if (along_sheet.weight < kWithinSheet) {
          within.push_back(along_sheet);
        } else {
          unknown.push_back(edge);
        }
        break;
      }
      case SheetSplit::Relation::perhaps_within: between.push_back({edge, false}); break;
      case SheetSplit::Relation::perhaps_across:
      case SheetSplit::Relation::across: between.push_back({edge, true}); break;
      case SheetSplit::Relation::unknown: unknown.push_back(edge); break;
    }
  }
  std::sort(within.begin(), within.end());
  std::vector<RankedEdge> edges = within;
  const std::vector<Index> sheet = orient(std::move(within), normals);
  for (const RankedEdge& vote : majority_votes(between, sheet, normals)) edges.push_back(vote);
  const auto first_unknown = static_cast<std::ptrdiff_t>(edges.size());
  for (const NeighbourGraph::Edge& edge : unknown) edges.push_back(ranked(points, normals, edge));
  std::sort(edges.begin() + first_unknown, edges.end());
  // Signs have changed since they were compared.
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(edges.size()); ++i) {
    RankedEdge& edge = edges[static_cast<std::size_t>(i)];
    if (!edge.opposite) edge.flips = compare_normals(points, normals, edge.edge).agreement < 0;
  }
  return orient(std::move(edges), normals);
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

// The flux of a thin piece is the small difference of its two faces', less than what their areas are uncertain by.
void turn_from_opposite(const Points& points, const SheetSplit& split, const std::vector<Index>& piece,
                        Points& normals) {
  struct Votes {
    Index all = 0;
    Index split = 0;
    Index inside = 0;
  };
  std::map<Index, Votes> votes;
  for (Index i = 0; i < points.cols(); ++i) {
    Votes& vote = votes[piece[static_cast<std::size_t>(i)]];
    ++vote.all;
    if (!split.is_split(i)) continue;
    ++vote.split;
    if ((points.col(split.opposite(i)) - points.col(i)).dot(normals.col(i)) < 0) ++vote.inside;
  }
  for (Index i = 0; i < points.cols(); ++i) {
    const Votes& vote = votes[piece[static_cast<std::size_t>(i)]];
    if (2 * vote.split > vote.all && 2 * vote.inside < vote.split) normals.col(i) *= -1;
  }
}

}  // namespace taut::detail
