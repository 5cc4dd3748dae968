// Which faces does a shortest path cross? The answer comes from a graph: in every cell that the surface may cross,
// bounds of the kinks' conditions tell which sides are possible there; each choice of sides that has a surface point
// nearby gives a node on its face, each kink one on the edge, each pair of kinks one in the corner. So a face or a
// strip much thinner than a cell has its nodes. Nodes on one face are joined where the middle of their chord has its
// foot on the face between them; Dijkstra's algorithm from both ends then gives, for each node, the length of the way
// through it, of which every hollow half-way is a way round. Within 2.3 cells there are some 20 directions to go: ways
// are at most 3 % too long.
#include "strata/facet_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <set>
#include <utility>

#include "taut/cells/subdivide.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// Nodes this many cells apart are joined.
constexpr double kReach = 2.3;
/// A point may be as far from the middle of its cell, in cells.
constexpr double kNearCell = 0.9;
/// Farther from the middle of the cell, in cells, a zero set is not looked for a second time.
constexpr double kFarFromCell = 2;
/// Beyond its face, the middle of a step along an edge may reach by this part of its length, since edges are curved;
/// that of another step by the second part: it must not cut a corner that reaches into the face.
constexpr double kBeyondEdge = 0.15;
constexpr double kBeyond = 0.03;
/// A step may be longer than its chord by this: a quarter circle is by 1.11.
constexpr double kLongStep = 1.3;
/// Conditions that vanish within this, relative to the model.
constexpr double kOnEdge = 1e-9;
/// Hollows of the way's length half-way are told apart when the ridge between them is higher by this.
constexpr double kRidge = 0.003;
constexpr std::size_t kMostWays = 48;
/// A wedge of more than this goes all around, radians.
constexpr double kWholeTurn = 6.28;
/// Angles above pi by this, radians, make a corner reach into a face; ways pass it within so many cells.
constexpr double kReflex = 1e-6;
constexpr double kBesideWay = 1.5;
constexpr double kFar = std::numeric_limits<double>::infinity();

void insert_face(std::vector<int>& faces, int face) {
  if (std::find(faces.begin(), faces.end(), face) == faces.end()) faces.push_back(face);
}

std::vector<int> common(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  for (const int face : a) {
    if (std::find(b.begin(), b.end(), face) != b.end()) both.push_back(face);
  }
  return both;
}

std::array<int, 3> bin_of(const Point3& x, double size) {
  return {static_cast<int>(std::floor(x.x() / size)), static_cast<int>(std::floor(x.y() / size)),
          static_cast<int>(std::floor(x.z() / size))};
}

}  // namespace

FacetGraph::FacetGraph(FacetedSurface& surface, const Box& box, double size, const Context& context)
    : surface_(surface), box_(box), size_(size) {
  const CellGrid grid = subdivide(surface.surface(), {.size = size, .box = box}, context);
  size_ = grid.size();
  num_cells_ = grid.num_cells();
  std::vector<int> kinks;
  for (Index i = 0; i < grid.num_cells(); ++i) {
    if (i % 1024 == 0) context.check_cancelled();
    const Box cell = grid.box(i);
    surface.undecided(cell, kinks);
    fill_cell(cell, kinks);
  }
  if (nodes_.empty()) throw EmptySurface("no surface point was found in the cells");
  link();
}

void FacetGraph::add(Node node) {
  // Neighbouring cells find the same corner; and the same edge point where it lies between them.
  const double same = node.corner ? 1e-7 * surface_.scale : 1e-3 * size_;
  const std::array<int, 3> bin = bin_of(node.x, kReach * size_);
  for (const int dx : {-1, 0, 1}) {
    for (const int dy : {-1, 0, 1}) {
      for (const int dz : {-1, 0, 1}) {
        const auto found = bins_.find({bin[0] + dx, bin[1] + dy, bin[2] + dz});
        if (found == bins_.end()) continue;
        for (const std::uint32_t other : found->second) {
          const Node& known = nodes_[other];
          if (known.corner == node.corner && known.edge == node.edge && known.faces == node.faces &&
              (known.x - node.x).squaredNorm() < same * same) {
            return;
          }
        }
      }
    }
  }
  if (!node.reflex.empty()) reflex_.push_back(static_cast<std::uint32_t>(nodes_.size()));
  bins_[bin].push_back(static_cast<std::uint32_t>(nodes_.size()));
  nodes_.push_back(std::move(node));
}

/// From the centre, and if need be from the corners of the cell: a formula such as sqrt(max(z, 0)^2) - r has a second
/// sheet beyond its face, where a start on the wrong side ends.
template <class IsRight>
bool FacetGraph::find_point(const Box& cell, int face, const std::vector<int>& conditions, bool try_corners,
                            const IsRight& is_right, Point3& x) {
  const Point3 centre = (cell.lower + cell.upper) / 2;
  const double near = kNearCell * size_;
  for (int start = -1; start < (try_corners ? 8 : 0); ++start) {
    if (start == 0) {
      // From corners only where the zero sets come near, to first order.
      Point3 gradient;
      const auto is_far = [&](double value) { return !(std::abs(value) <= kFarFromCell * size_ * gradient.norm()); };
      if (is_far(surface_.function(face, centre, gradient))) return false;
      for (const int c : conditions) {
        if (is_far(surface_.condition(c, centre, gradient))) return false;
      }
    }
    x = centre;
    for (int a = 0; start >= 0 && a < 3; ++a) x(a) = (start >> a & 1) != 0 ? cell.upper(a) : cell.lower(a);
    if (surface_.project(face, conditions, x) && (x - centre).norm() <= near && is_right(x)) return true;
  }
  return false;
}

void FacetGraph::fill_cell(const Box& cell, const std::vector<int>& kinks) {
  const Point3 centre = (cell.lower + cell.upper) / 2;
  const double on_edge = kOnEdge * surface_.scale;
  const bool try_corners = !kinks.empty();
  std::vector<int> seen;
  Point3 x;
  const auto choices = surface_.faces_near(centre, kinks);
  for (const auto& [face, sides] : choices) {
    if (std::find(seen.begin(), seen.end(), face) != seen.end()) continue;
    seen.push_back(face);
    const int wanted = face;
    if (find_point(
            cell, face, {}, try_corners, [&](const Point3& at) { return surface_.violation(wanted, at) == 0; }, x)) {
      add({x, {face}, -1, false});
    }
  }
  if (kinks.empty()) return;
  std::optional<Star> star;
  const auto add_star = [&](int edge, bool corner) {
    Node node{x, {}, edge, corner};
    for (const Wedge& wedge : star->wedges) {
      insert_face(node.faces, wedge.face);
      if (corner && wedge.angle > std::numbers::pi + kReflex) insert_face(node.reflex, wedge.face);
    }
    std::sort(node.faces.begin(), node.faces.end());
    add(std::move(node));
  };
  const auto is_corner = [&] { return star->wedges.size() > 2 || (!star->closed && star->wedges.size() > 1); };
  std::set<std::pair<int, int>> edges;
  std::set<std::array<int, 3>> corners;
  for (const auto& [face, sides] : choices) {
    for (std::size_t i = 0; i < kinks.size(); ++i) {
      const int c = surface_.smooth_condition(kinks[i], sides);
      if (edges.insert({face, c}).second && find_point(
                                                cell, face, {c}, true,
                                                [&](const Point3& at) {
                                                  star = surface_.star(at, on_edge);
                                                  return star && star->wedges.front().angle < kWholeTurn;
                                                },
                                                x)) {
        add_star(is_corner() ? -1 : star->wedges.front().second_edge, is_corner());
      }
      for (std::size_t j = 0; j < i; ++j) {
        const int other = surface_.smooth_condition(kinks[j], sides);
        if (other == c || !corners.insert({face, std::min(c, other), std::max(c, other)}).second) continue;
        if (find_point(
                cell, face, {c, other}, true,
                [&](const Point3& at) {
                  star = surface_.star(at, on_edge);
                  // Closed with two wedges: the kinks do not meet in a corner of this face.
                  return star && star->wedges.front().angle < kWholeTurn && !(star->closed && star->wedges.size() == 2);
                },
                x)) {
          add_star(-1, true);
        }
      }
    }
  }
}

/// Length of a step on a face, infinite where it is none: over the foot of the chord's middle.
double FacetGraph::step(int face, const Point3& a, const Point3& b, bool along_edge) const {
  const double chord = (b - a).norm();
  if (chord == 0) return 0;
  Point3 middle = (a + b) / 2;
  const Point3 from = middle;
  if (!surface_.project(face, {}, middle) || (middle - from).norm() > 0.6 * chord) return kFar;
  const double length = (middle - a).norm() + (b - middle).norm();
  if (length > kLongStep * chord) return kFar;
  if (surface_.violation(face, middle) > (along_edge ? kBeyondEdge : kBeyond) * chord) return kFar;
  return length;
}

double FacetGraph::joined(const Node& a, const Node& b) const {
  double length = kFar;
  const bool along_edge = a.edge >= 0 && a.edge == b.edge;
  for (const int face : common(a.faces, b.faces)) length = std::min(length, step(face, a.x, b.x, along_edge));
  return length;
}

std::vector<FacetGraph::Link> FacetGraph::links_of(const Node& node, double reach) const {
  std::vector<Link> found;
  const double size = kReach * size_;
  const std::array<int, 3> bin = bin_of(node.x, size);
  const int wide = static_cast<int>(std::ceil(reach / size));
  for (int dx = -wide; dx <= wide; ++dx) {
    for (int dy = -wide; dy <= wide; ++dy) {
      for (int dz = -wide; dz <= wide; ++dz) {
        const auto at = bins_.find({bin[0] + dx, bin[1] + dy, bin[2] + dz});
        if (at == bins_.end()) continue;
        for (const std::uint32_t other : at->second) {
          if ((nodes_[other].x - node.x).squaredNorm() > reach * reach) continue;
          const double length = joined(node, nodes_[other]);
          if (length < kFar) found.push_back({other, static_cast<float>(length)});
        }
      }
    }
  }
  return found;
}

void FacetGraph::link() {
  links_.resize(nodes_.size());
  const double reach = kReach * size_;
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const std::array<int, 3> bin = bin_of(nodes_[i].x, reach);
    for (const int dx : {-1, 0, 1}) {
      for (const int dy : {-1, 0, 1}) {
        for (const int dz : {-1, 0, 1}) {
          const auto at = bins_.find({bin[0] + dx, bin[1] + dy, bin[2] + dz});
          if (at == bins_.end()) continue;
          for (const std::uint32_t j : at->second) {
            if (j <= i || (nodes_[j].x - nodes_[i].x).squaredNorm() > reach * reach) continue;
            const double length = joined(nodes_[i], nodes_[j]);
            if (!(length < kFar)) continue;
            links_[i].push_back({j, static_cast<float>(length)});
            links_[j].push_back({i, static_cast<float>(length)});
          }
        }
      }
    }
  }
}

std::vector<FacetWay> FacetGraph::ways(const Point3& p, const Point3& q, double slack) const {
  const auto end_node = [&](const Point3& x) {
    Node node{x, {}, -1, false};
    const std::optional<Star> star = surface_.star(x, 1e-8 * surface_.scale);
    if (!star) return node;
    for (const Wedge& wedge : star->wedges) insert_face(node.faces, wedge.face);
    if (star->wedges.size() > 1 || !star->closed) node.edge = star->wedges.front().second_edge;
    return node;
  };
  const Node from = end_node(p);
  const Node to = end_node(q);
  const auto n = static_cast<std::uint32_t>(nodes_.size());
  // p and q are nodes n and n + 1.
  std::array<std::vector<Link>, 2> ends;
  for (const int end : {0, 1}) {
    const Node& node = end == 0 ? from : to;
    for (double reach = kReach * size_; reach <= 4 * kReach * size_ && ends[end].empty(); reach *= 2) {
      ends[end] = links_of(node, reach);
    }
  }
  const double direct = joined(from, to);
  const auto node_at = [&](std::uint32_t i) -> const Node& { return i == n ? from : i == n + 1 ? to : nodes_[i]; };
  std::vector<float> near_start(n, -1);
  std::vector<float> near_end(n, -1);
  for (const Link& link : ends[0]) near_start[link.to] = link.length;
  for (const Link& link : ends[1]) near_end[link.to] = link.length;

  struct Tree {
    std::vector<double> length;
    std::vector<std::uint32_t> before;
  };
  const auto grow = [&](std::uint32_t source) {
    Tree tree{std::vector<double>(n + 2, kFar), std::vector<std::uint32_t>(n + 2, n + 2)};
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    tree.length[source] = 0;
    front.push({0, source});
    while (!front.empty()) {
      const auto [length, at] = front.top();
      front.pop();
      if (length > tree.length[at]) continue;
      const auto relax = [&](std::uint32_t next, double step) {
        if (!(length + step < tree.length[next])) return;
        tree.length[next] = length + step;
        tree.before[next] = at;
        front.push({length + step, next});
      };
      if (at >= n) {
        if (at != source) continue;
        for (const Link& link : ends[at - n]) relax(link.to, link.length);
        if (direct < kFar) relax(at == n ? n + 1 : n, direct);
        continue;
      }
      for (const Link& link : links_[at]) relax(link.to, link.length);
      if (near_start[at] >= 0) relax(n, near_start[at]);
      if (near_end[at] >= 0) relax(n + 1, near_end[at]);
    }
    return tree;
  };
  const Tree a = grow(n);
  const Tree b = grow(n + 1);
  if (!(a.length[n + 1] < kFar)) return {};

  const auto way_through = [&](std::uint32_t middle) {
    std::vector<std::uint32_t> row;
    for (std::uint32_t at = middle; at != n + 2; at = a.before[at]) row.push_back(at);
    std::reverse(row.begin(), row.end());
    for (std::uint32_t at = b.before[middle]; at != n + 2; at = b.before[at]) row.push_back(at);
    FacetWay way;
    way.length = a.length[middle] + b.length[middle];
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Node& node = node_at(row[i]);
      way.points.push_back(node.x);
      way.corner.push_back(node.corner);
      way.edge.push_back(node.edge);
      if (i > 0) {
        const Node& other = node_at(row[i - 1]);
        std::vector<int> faces;
        for (const int face : common(other.faces, node.faces)) {
          if (step(face, other.x, node.x, other.edge >= 0 && other.edge == node.edge) < kFar) faces.push_back(face);
        }
        way.faces.push_back(std::move(faces));
      }
    }
    for (const std::uint32_t corner : reflex_) {
      const Point3& x = nodes_[corner].x;
      double least = kBesideWay * size_;
      std::size_t nearest = way.faces.size();
      for (std::size_t i = 0; i + 1 < way.points.size(); ++i) {
        const Point3 along = way.points[i + 1] - way.points[i];
        const double u = std::clamp(along.dot(x - way.points[i]) / along.squaredNorm(), 0.0, 1.0);
        const double away = (way.points[i] + u * along - x).norm();
        if (away >= least) continue;
        least = away;
        nearest = i;
      }
      const bool on_way = least <= 1e-9 * surface_.scale;
      if (nearest < way.faces.size() && !on_way) way.reflex.push_back({x, nodes_[corner].reflex, nearest});
    }
    return way;
  };

  // Nodes half-way, and the hollows of the way's length there.
  const double best = a.length[n + 1];
  const double half = 1.2 * kReach * size_;
  std::vector<std::uint32_t> middle;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (a.length[i] + b.length[i] <= slack * best && std::abs(a.length[i] - b.length[i]) <= half) middle.push_back(i);
  }
  const auto total = [&](std::uint32_t i) { return a.length[i] + b.length[i]; };
  std::stable_sort(middle.begin(), middle.end(), [&](auto i, auto j) { return total(i) < total(j); });
  std::vector<std::uint32_t> hollows{n + 1};
  {
    std::vector<int> rank(n, -1);
    std::vector<std::size_t> root(middle.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    std::vector<bool> kept(middle.size(), false);
    for (std::size_t i = 0; i < middle.size(); ++i) {
      rank[middle[i]] = static_cast<int>(i);
      for (const Link& link : links_[middle[i]]) {
        if (rank[link.to] < 0) continue;
        std::size_t one = find(i);
        std::size_t two = find(static_cast<std::size_t>(rank[link.to]));
        if (one == two) continue;
        if (total(middle[one]) > total(middle[two])) std::swap(one, two);
        // The higher hollow ends at this ridge.
        if (total(middle[i]) - total(middle[two]) > kRidge * best) kept[two] = true;
        root[two] = one;
      }
    }
    for (std::size_t i = 0; i < middle.size(); ++i) {
      if (kept[i] || find(i) == i) hollows.push_back(middle[i]);
    }
  }
  std::vector<FacetWay> found;
  std::set<std::vector<int>> rows;
  const auto signature = [](const FacetWay& way) {
    std::vector<int> row;
    std::vector<int> current;
    for (const std::vector<int>& faces : way.faces) {
      std::vector<int> both = current.empty() ? faces : common(current, faces);
      if (both.empty()) {
        row.push_back(current.empty() ? -1 : current.front());
        both = faces;
      }
      current = std::move(both);
    }
    if (!current.empty()) row.push_back(current.front());
    return row;
  };
  for (const std::uint32_t hollow : hollows) {
    found.push_back(way_through(hollow));
    rows.insert(signature(found.back()));
  }
  for (const std::uint32_t node : middle) {
    if (found.size() >= kMostWays) break;
    if (total(node) > (1 + (slack - 1) / 2) * best) break;
    FacetWay way = way_through(node);
    if (rows.insert(signature(way)).second) found.push_back(std::move(way));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const FacetWay& x, const FacetWay& y) { return x.length < y.length; });
  if (found.size() > kMostWays) found.resize(kMostWays);
  return found;
}

}  // namespace taut::detail
