// Ways over a graph from p to q. Dijkstra's algorithm runs from both ends, no farther than ways may lead; then
// a(i) + b(i) is the length of the shortest way through node i. Every hollow of it half-way is a way round; so is every
// other row of faces through some node.
#include "strata/facet_ways.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace taut::detail {
namespace {

/// Hollows of the way's length half-way are told apart when the ridge between them is higher by this.
constexpr double kRidge = 0.003;
/// Beside a straight line of length L ways through points at a distance d rise by 2 (d / L)^2. Where they rise by less
/// than half of that, at least so far from it, a hollow is so flat that another may hide in it: the graph's lengths are
/// wrong by some per cent. Of 21,000 pairs on 35 shapes two were missed without (bench/face_campaign.py).
constexpr double kFlat = 0.15;
constexpr std::size_t kMostWays = 48;
/// Corners that reach into a face are told of within so many cells of a way.
constexpr double kBesideWay = 1.5;
/// Nodes around an end are looked for in wider and wider balls, up to so many times the usual reach.
constexpr double kWidestEnd = 4;
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNoNodeBefore = ~std::uint32_t{0};

/// Lengths from one end, in the order of their size up to the width of a bucket: a node whose length falls later is
/// looked at again.
class Tree {
 public:
  Tree(const FacetGraph& graph, const std::vector<FacetLink>& from)
      : graph_(graph),
        per_width_(1 / (kWidth * graph.size())),
        length_(graph.nodes().size(), kFar),
        before_(graph.nodes().size(), kNoNodeBefore),
        by_(graph.nodes().size(), nullptr) {
    for (const FacetLink& link : from) reach(link, 0, kNoNodeBefore);
  }

  /// All lengths up to this are known.
  [[nodiscard]] double radius() const { return static_cast<double>(current_) / per_width_; }
  [[nodiscard]] bool ended() const { return open_ == 0; }
  [[nodiscard]] double length(std::uint32_t node) const { return length_[node]; }
  /// The node before, or kNoNodeBefore after the end itself.
  [[nodiscard]] std::uint32_t before(std::uint32_t node) const { return before_[node]; }
  /// The step by which it is come to: of the node before, or of the end. Null where the tree does not reach it.
  [[nodiscard]] const FacetLink* by(std::uint32_t node) const { return by_[node]; }
  /// No way from the end to the node is shorter, of those that were not left.
  [[nodiscard]] double least(std::uint32_t node) const { return std::min(length_[node], radius()); }

  /// Takes out one bucket; `met` is called with every node in it. Ways to `other`, the other end, that are longer than
  /// `longest` are left: a straight line and the other tree are lower bounds of what they lack.
  template <class Met>
  void advance(const Tree& there, const Point3& other, double longest, const Met& met) {
    std::vector<Entry>& bucket = buckets_[current_ % kBuckets];
    // It grows while it is worked off.
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const Entry entry = bucket[i];
      if (entry.length > length_[entry.node]) continue;
      met(entry.node);
      if (entry.length + there.least(entry.node) > longest) continue;
      if (entry.length + (graph_.nodes()[entry.node].x - other).norm() > longest) continue;
      for (const FacetLink& link : graph_.links(entry.node)) reach(link, entry.length, entry.node);
    }
    open_ -= bucket.size();
    bucket.clear();
    ++current_;
  }

 private:
  static constexpr double kWidth = 0.25;  // cells
  // More than the longest step (an end's) is wide.
  static constexpr std::uint64_t kBuckets = 64;
  static_assert(kWidth * kBuckets > FacetGraph::kReach * FacetSteps::kLongStep * kWidestEnd + 2 * kWidth);
  struct Entry {
    double length;
    std::uint32_t node;
  };
  void reach(const FacetLink& link, double length_before, std::uint32_t before) {
    const std::uint32_t node = link.to;
    const double length = length_before + static_cast<double>(link.length);
    if (!(length < length_[node])) return;
    length_[node] = length;
    before_[node] = before;
    by_[node] = &link;
    const auto bucket = std::max(current_, static_cast<std::uint64_t>(length * per_width_));
    buckets_[bucket % kBuckets].push_back({length, node});
    ++open_;
  }

  const FacetGraph& graph_;
  double per_width_;
  std::vector<double> length_;
  std::vector<std::uint32_t> before_;
  std::vector<const FacetLink*> by_;
  std::array<std::vector<Entry>, kBuckets> buckets_;
  std::uint64_t current_ = 0;
  std::size_t open_ = 0;
};

std::vector<int> common_faces(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  for (const int face : a) {
    if (std::find(b.begin(), b.end(), face) != b.end()) both.push_back(face);
  }
  return both;
}

FacetNode end_node(FacetedSurface& surface, const Point3& x) {
  FacetNode node{x, {}};
  constexpr double kAround = 1e-8;
  const std::optional<Star> star = surface.star(x, kAround * surface.scale);
  if (!star) return node;
  for (const Wedge& wedge : star->wedges) {
    if (std::find(node.faces.begin(), node.faces.end(), wedge.face) == node.faces.end()) {
      node.faces.push_back(wedge.face);
    }
  }
  if (star->wedges.size() > 1 || !star->closed) node.edge = star->wedges.front().second_edge;
  return node;
}

/// Faces of a step, as bits of the faces of the node it leaves.
std::vector<int> faces_of(const FacetNode& from, std::uint32_t bits) {
  std::vector<int> faces;
  for (std::size_t i = 0; bits != 0; ++i, bits >>= 1) {
    if ((bits & 1) != 0) faces.push_back(from.faces[i]);
  }
  return faces;
}

/// Sets of faces by numbers.
class FaceSets {
 public:
  /// Of a step from a node.
  [[nodiscard]] int of(const FacetNode& from, std::uint32_t bits) {
    if (from.faces.size() > 1) return of(faces_of(from, bits));
    const auto face = static_cast<std::size_t>(from.faces.front());
    if (single_.size() <= face) single_.resize(face + 1, -1);
    if (single_[face] < 0) single_[face] = of(from.faces);
    return single_[face];
  }
  /// -1: none.
  [[nodiscard]] int common(int a, int b) {
    if (a == b) return a;
    const auto [known, added] = common_.try_emplace({a, b}, -1);
    if (!added) return known->second;
    const std::vector<int> both = common_faces(sets_[static_cast<std::size_t>(a)], sets_[static_cast<std::size_t>(b)]);
    return known->second = both.empty() ? -1 : of(both);
  }

 private:
  [[nodiscard]] int of(const std::vector<int>& faces) {
    const auto [known, added] = number_.try_emplace(faces, static_cast<int>(sets_.size()));
    if (added) sets_.push_back(faces);
    return known->second;
  }

  std::vector<std::vector<int>> sets_;
  std::map<std::vector<int>, int> number_;
  std::vector<int> single_;  // of one face
  std::map<std::pair<int, int>, int> common_;
};

/// Both trees, and what is asked of them.
class WaySearch {
 public:
  WaySearch(FacetedSurface& surface, const FacetGraph& graph, const Point3& p, const Point3& q)
      : surface_(surface), graph_(graph), ends_{end_node(surface, p), end_node(surface, q)} {
    for (const std::size_t end : {0U, 1U}) {
      for (double reach = FacetGraph::kReach; reach <= kWidestEnd * FacetGraph::kReach && links_[end].empty();
           reach *= 2) {
        links_[end] = graph.links_of(surface, ends_[end], reach * graph.size());
        reach_ = std::max(reach_, reach * graph.size());
      }
    }
    // Farther apart, the middle of a step says nothing of what lies on the way.
    if ((p - q).norm() <= FacetGraph::kReach * graph.size()) direct_ = step_between(surface, ends_[0], ends_[1]);
  }

  [[nodiscard]] std::vector<FacetWay> find(double slack);

 private:
  using Row = std::vector<int>;
  [[nodiscard]] double total(std::uint32_t node) const { return tree(0).length(node) + tree(1).length(node); }
  [[nodiscard]] const Tree& tree(std::size_t end) const { return *trees_[end]; }
  /// Ways no longer than so many times the shortest tell rows of faces.
  [[nodiscard]] static double slack_of_rows(double slack) { return 1 + (slack - 1) / 2; }
  void grow(double slack);
  [[nodiscard]] FacetWay way_through(std::uint32_t node) const;
  [[nodiscard]] FacetWay direct_way() const;
  [[nodiscard]] FacetWay way_of(const std::vector<const FacetNode*>& nodes, double length,
                                std::vector<std::vector<int>> faces) const;
  [[nodiscard]] std::vector<int> step_faces(std::size_t end, std::uint32_t node) const;
  [[nodiscard]] std::vector<std::uint32_t> hollows(const std::vector<std::uint32_t>& middle) const;
  void add_flat_parts(const std::vector<std::uint32_t>& middle, std::vector<std::uint32_t>& hollows) const;
  [[nodiscard]] int label(std::size_t end, std::uint32_t node);
  [[nodiscard]] Row row_through(std::uint32_t node);
  static void add(const FacetWay& way, bool is_hollow, std::set<Row>& rows, std::vector<FacetWay>& found);

  /// The row of faces from an end to a node.
  struct Label {
    int before;  // -1: none
    int faces;   // the set of those that all steps since then lie on
  };
  [[nodiscard]] static std::uint64_t key_of(int a, int b) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
  }

  FacetedSurface& surface_;
  const FacetGraph& graph_;
  std::array<FacetNode, 2> ends_;
  std::array<std::vector<FacetLink>, 2> links_;
  double reach_ = 0;  // of the ends
  FacetLink direct_;
  std::array<std::optional<Tree>, 2> trees_;
  double best_ = kFar;
  std::array<std::vector<Label>, 2> labels_;
  std::array<std::unordered_map<std::uint64_t, int>, 2> label_of_row_;
  std::array<std::vector<int>, 2> label_of_node_;
  std::vector<std::uint32_t> open_;  // scratch of label
  FaceSets sets_;
};

/// Half-way, a way's lengths to its ends differ by no more than a step. Rows of faces are told apart along the whole
/// way.
void WaySearch::grow(double slack) {
  best_ = static_cast<double>(direct_.length);
  for (const std::size_t end : {0U, 1U}) trees_[end].emplace(graph_, links_[end]);
  const double step = FacetSteps::kLongStep * reach_;
  const auto advance = [&](std::size_t end, double part) {
    trees_[end]->advance(tree(1 - end), ends_[1 - end].x, part * best_,
                         [&](std::uint32_t node) { best_ = std::min(best_, total(node)); });
  };
  const auto nearer = [&] { return trees_[0]->radius() <= trees_[1]->radius() ? 0U : 1U; };
  const auto ended = [&] { return trees_[0]->ended() && trees_[1]->ended(); };
  while (!ended() && tree(nearer()).radius() <= (slack * best_ + step) / 2) advance(nearer(), slack);
  // Beyond the middle the other tree knows what ways lack.
  const double row_slack = slack_of_rows(slack);
  while (!ended() && tree(nearer()).radius() <= row_slack * best_) advance(nearer(), row_slack);
}

/// Faces of the step by which the tree of an end comes to a node.
std::vector<int> WaySearch::step_faces(std::size_t end, std::uint32_t node) const {
  const std::uint32_t before = tree(end).before(node);
  return faces_of(before == kNoNodeBefore ? ends_[end] : graph_.nodes()[before], tree(end).by(node)->faces);
}

FacetWay WaySearch::way_of(const std::vector<const FacetNode*>& nodes, double length,
                           std::vector<std::vector<int>> faces) const {
  FacetWay way;
  way.length = length;
  way.faces = std::move(faces);
  for (const FacetNode* node : nodes) {
    way.points.push_back(node->x);
    way.corner.push_back(node->corner);
    way.edge.push_back(node->edge);
  }
  for (const std::uint32_t corner : graph_.reflex_corners()) {
    const Point3& x = graph_.nodes()[corner].x;
    double least = kBesideWay * graph_.size();
    std::size_t nearest = way.faces.size();
    for (std::size_t i = 0; i + 1 < way.points.size(); ++i) {
      const Point3 along = way.points[i + 1] - way.points[i];
      const double u = std::clamp(along.dot(x - way.points[i]) / along.squaredNorm(), 0.0, 1.0);
      const double away = (way.points[i] + u * along - x).norm();
      if (away >= least) continue;
      least = away;
      nearest = i;
    }
    constexpr double kOnWay = 1e-9;
    const bool on_way = least <= kOnWay * surface_.scale;
    if (nearest < way.faces.size() && !on_way) way.reflex.push_back({x, graph_.nodes()[corner].reflex, nearest});
  }
  return way;
}

FacetWay WaySearch::way_through(std::uint32_t node) const {
  std::vector<const FacetNode*> nodes;
  std::vector<std::vector<int>> faces;
  for (std::uint32_t at = node; at != kNoNodeBefore; at = tree(0).before(at)) {
    nodes.push_back(&graph_.nodes()[at]);
    faces.push_back(step_faces(0, at));
  }
  nodes.push_back(ends_.data());
  std::reverse(nodes.begin(), nodes.end());
  std::reverse(faces.begin(), faces.end());
  for (std::uint32_t at = node; at != kNoNodeBefore; at = tree(1).before(at)) {
    if (at != node) nodes.push_back(&graph_.nodes()[at]);
    faces.push_back(step_faces(1, at));
  }
  nodes.push_back(&ends_[1]);
  return way_of(nodes, total(node), std::move(faces));
}

FacetWay WaySearch::direct_way() const {
  return way_of({ends_.data(), &ends_[1]}, static_cast<double>(direct_.length), {faces_of(ends_[0], direct_.faces)});
}

/// Of nodes in the order of the ways through them: the lowest of each hollow.
std::vector<std::uint32_t> WaySearch::hollows(const std::vector<std::uint32_t>& middle) const {
  std::vector<std::uint32_t> found;
  std::vector<int> rank(graph_.nodes().size(), -1);
  std::vector<std::size_t> root(middle.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::vector<bool> kept(middle.size(), false);
  for (std::size_t i = 0; i < middle.size(); ++i) {
    rank[middle[i]] = static_cast<int>(i);
    for (const FacetLink& link : graph_.links(middle[i])) {
      if (rank[link.to] < 0) continue;
      std::size_t one = root_of(i);
      std::size_t two = root_of(static_cast<std::size_t>(rank[link.to]));
      if (one == two) continue;
      if (total(middle[one]) > total(middle[two])) std::swap(one, two);
      // The higher hollow ends at this ridge.
      if (total(middle[i]) - total(middle[two]) > kRidge * best_) kept[two] = true;
      root[two] = one;
    }
  }
  for (std::size_t i = 0; i < middle.size(); ++i) {
    if (kept[i] || root_of(i) == i) found.push_back(middle[i]);
  }
  return found;
}

/// Nodes of flat hollows that are far from the others.
void WaySearch::add_flat_parts(const std::vector<std::uint32_t>& middle, std::vector<std::uint32_t>& hollows) const {
  for (const std::uint32_t node : middle) {
    if (hollows.size() >= kMostWays) break;
    const auto explains = [&](std::uint32_t hollow) {
      const double aside = (graph_.nodes()[node].x - graph_.nodes()[hollow].x).norm() / best_;
      return aside < kFlat || total(node) > (1 + aside * aside) * total(hollow);
    };
    if (std::none_of(hollows.begin(), hollows.end(), explains)) hollows.push_back(node);
  }
}

/// Steps that share a face are one part of the row.
int WaySearch::label(std::size_t end, std::uint32_t node) {
  std::vector<int>& labels = label_of_node_[end];
  labels.resize(graph_.nodes().size(), -1);
  open_.clear();
  for (std::uint32_t at = node; at != kNoNodeBefore && labels[at] < 0; at = tree(end).before(at)) open_.push_back(at);
  for (; !open_.empty(); open_.pop_back()) {
    const std::uint32_t at = open_.back();
    const std::uint32_t before = tree(end).before(at);
    const FacetNode& from = before == kNoNodeBefore ? ends_[end] : graph_.nodes()[before];
    int faces = sets_.of(from, tree(end).by(at)->faces);
    int previous = before == kNoNodeBefore ? -1 : labels[before];
    if (previous >= 0) {
      const Label& last = labels_[end][static_cast<std::size_t>(previous)];
      if (const int both = sets_.common(last.faces, faces); both >= 0) {
        faces = both;
        previous = last.before;
      }
    }
    const auto [known, added] =
        label_of_row_[end].try_emplace(key_of(previous, faces), static_cast<int>(labels_[end].size()));
    if (added) labels_[end].push_back({previous, faces});
    labels[at] = known->second;
  }
  return labels[node];
}

/// The numbers of the sets of faces of the row's parts.
WaySearch::Row WaySearch::row_through(std::uint32_t node) {
  const auto half = [&](std::size_t end) {
    Row parts;
    for (int at = label(end, node); at >= 0; at = labels_[end][static_cast<std::size_t>(at)].before) {
      parts.push_back(labels_[end][static_cast<std::size_t>(at)].faces);
    }
    return parts;
  };
  Row row = half(0);
  const Row second = half(1);
  const int both = sets_.common(row.front(), second.front());
  std::reverse(row.begin(), row.end());
  if (both >= 0) row.back() = both;
  row.insert(row.end(), second.begin() + (both >= 0 ? 1 : 0), second.end());
  return row;
}

/// Adds the way, unless its row of faces is there already; that of a hollow in any case: it is another way round. A
/// part of it may lie on an edge, and so on several faces: then each of them makes a row.
void WaySearch::add(const FacetWay& way, bool is_hollow, std::set<Row>& rows, std::vector<FacetWay>& found) {
  struct Part {
    std::size_t first;
    Row faces;
  };
  std::vector<Part> parts;
  for (std::size_t i = 0; i < way.faces.size(); ++i) {
    Row both = parts.empty() ? Row{} : common_faces(parts.back().faces, way.faces[i]);
    if (both.empty()) {
      parts.push_back({i, way.faces[i]});
    } else {
      parts.back().faces = std::move(both);
    }
  }
  Row row;
  for (const Part& part : parts) row.push_back(part.faces.empty() ? -1 : part.faces.front());
  if (rows.insert(row).second || is_hollow) found.push_back(way);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t end = k + 1 < parts.size() ? parts[k + 1].first : way.faces.size();
    for (std::size_t f = 1; f < parts[k].faces.size() && found.size() < kMostWays; ++f) {
      Row other = row;
      other[k] = parts[k].faces[f];
      if (!rows.insert(other).second) continue;
      found.push_back(way);
      for (std::size_t i = parts[k].first; i < end; ++i) found.back().faces[i] = {parts[k].faces[f]};
    }
  }
}

std::vector<FacetWay> WaySearch::find(double slack) {
  grow(slack);
  std::vector<FacetWay> found;
  if (!(best_ < kFar)) return found;
  const auto n = static_cast<std::uint32_t>(graph_.nodes().size());
  const double half = FacetSteps::kLongStep * reach_;
  const double longest_row = slack_of_rows(slack) * best_;
  using Through = std::pair<double, std::uint32_t>;  // the length of the way through a node
  std::vector<Through> near_middle;
  std::vector<Through> others;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double length = total(i);
    if (length > slack * best_) continue;
    if (std::abs(tree(0).length(i) - tree(1).length(i)) <= half) near_middle.emplace_back(length, i);
    if (length <= longest_row) others.emplace_back(length, i);
  }
  std::sort(near_middle.begin(), near_middle.end());
  std::vector<std::uint32_t> middle;
  for (const auto& [length, node] : near_middle) middle.push_back(node);
  if (static_cast<double>(direct_.length) <= slack * best_) found.push_back(direct_way());
  std::set<Row> rows;
  std::vector<std::uint32_t> lowest = hollows(middle);
  add_flat_parts(middle, lowest);
  for (const std::uint32_t hollow : lowest) add(way_through(hollow), true, rows, found);
  // Not only half-way: another row may pass a corner near an end on its other side.
  std::sort(others.begin(), others.end());
  std::unordered_set<std::uint64_t> labels;
  std::set<Row> seen;
  for (const auto& [length, node] : others) {
    if (found.size() >= kMostWays) break;
    if (!labels.insert(key_of(label(0, node), label(1, node))).second) continue;
    if (seen.insert(row_through(node)).second) add(way_through(node), false, rows, found);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const FacetWay& x, const FacetWay& y) { return x.length < y.length; });
  if (found.size() > kMostWays) found.resize(kMostWays);
  return found;
}

}  // namespace

std::vector<FacetWay> ways_between(FacetedSurface& surface, const FacetGraph& graph, const Point3& p, const Point3& q,
                                   double slack) {
  return WaySearch(surface, graph, p, q).find(slack);
}

}  // namespace taut::detail
