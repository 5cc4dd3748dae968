// Edges as curves. Every point of an edge that the graph has begins a walk along it in both directions, until the edge
// ends in a corner, leaves the box, or comes back to where it began; points that a walk has passed begin none. Lengths
// come from arcs between some of the points (edge_arc). Faces fall into patches: points inside that steps of the graph
// join.
#include "strata/edge_network.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "strata/chain_tolerances.hpp"
#include "strata/edge_arc.hpp"
#include "strata/edge_walk.hpp"

namespace taut::detail {
namespace {

/// A step along an edge, in cells of the graph, and the smallest one: an edge that turns within it ends in a point
/// where its conditions touch. Nearer to that point than the root of rounding the edge is not determined.
constexpr double kStep = 0.5;
constexpr double kLeastStep = 1e-6;
/// The edge turns by no more than this within a step: 1 - cosine. Chords then stray by 1 % of a step.
constexpr double kTurn = 4e-3;
/// A node of the same edge as near to a walk, in cells, has been passed.
constexpr double kPassed = 0.03;
/// A corner lies on an edge whose conditions vanish there within this, relative to the model.
constexpr double kAtCorner = 1e-8;
/// An edge's end is found to the square root of the conditions' rounding: corners as near are its end, and without one
/// it is made exact.
constexpr double kNearEnd = 1e-4;
/// Corners as near, relative to the model, are one.
constexpr double kSameCorner = 1e-7;
/// Steps of one walk.
constexpr int kMostSteps = 20000;
/// Marks that lengths are measured between: so many of a line's points lie between two.
constexpr std::size_t kBetweenMarks = 4;
/// Steps that pass a point where faces touch within this, in cells, join no patches.
constexpr double kBesideTouching = 0.5;
/// Places along a line where the angle between its faces is looked at.
constexpr int kLooks = 5;

/// Each once, in order.
std::vector<int> joined(std::vector<int> a, const std::vector<int>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

/// A border may pass a kink of its domain straight on: that is a corner of the graph, but none of the surface.
bool is_corner(FacetedSurface& surface, const Point3& x) {
  const std::optional<Star> star = surface.star(x, ChainTolerances::on_edge * surface.scale);
  return !star || star->closed || star->wedges.size() > 1 ||
         star->wedges.front().first_condition != star->wedges.front().second_condition;
}

/// Steps from x along an edge that end where the edge does.
class EdgeFollower {
 public:
  EdgeFollower(FacetedSurface& surface, const FacetGraph& graph, std::vector<EdgeCorner>& corners)
      : s_(surface), graph_(graph), corners_(corners) {}

  EdgeLine follow(int edge, const Point3& from) {
    EdgeLine line;
    line.edge = edge;
    line.points = walk(line, from, 1);
    if (line.closed) return line;
    std::vector<Point3> back = walk(line, from, -1);
    std::reverse(back.begin(), back.end());
    back.pop_back();
    line.points.insert(line.points.begin(), back.begin(), back.end());
    return line;
  }

 private:
  /// A corner of the edge's faces that the step from x to y passes or meets; null: none.
  const EdgeCorner* corner_within(int e, const Point3& x, const Point3& y) {
    const SharpEdge edge = s_.edge(e);
    const double step = (y - x).norm();
    const EdgeCorner* nearest = nullptr;
    for (const EdgeCorner& corner : corners_) {
      const Point3 off = corner.x - x;
      if (off.norm() > 1.1 * step + kNearEnd * s_.scale) continue;
      if (off.dot(y - x) <= kAtCorner * s_.scale * step) continue;
      if (nearest != nullptr && (nearest->x - x).norm() <= off.norm()) continue;
      if (std::find(corner.faces.begin(), corner.faces.end(), edge.a) == corner.faces.end()) continue;
      if (edge.b >= 0 && std::find(corner.faces.begin(), corner.faces.end(), edge.b) == corner.faces.end()) continue;
      // A condition's gradient may vanish in the corner: then that of the step's start counts.
      Point3 here;
      Point3 there;
      (void)s_.function(edge.a, x, here);
      double f = s_.function(edge.a, corner.x, there);
      f /= std::max(here.norm(), there.norm());
      (void)s_.condition(edge.condition, x, here);
      double c = s_.condition(edge.condition, corner.x, there);
      c /= std::max(here.norm(), there.norm());
      if (std::max(std::abs(f), std::abs(c)) <= kAtCorner * s_.scale) nearest = &corner;
    }
    return nearest;
  }

  [[nodiscard]] std::vector<int> edge_faces(int e) const {
    const SharpEdge& edge = s_.edge(e);
    return edge.b >= 0 ? std::vector<int>{edge.a, edge.b} : std::vector<int>{edge.a};
  }

  /// The end of an edge that the graph has no corner for.
  Point3 new_corner(int e, const EdgeWalk& end) {
    const SharpEdge edge = s_.edge(e);
    Point3 x = end.x;
    if (end.condition >= 0 && end.condition != edge.condition &&
        s_.project(edge.a, {edge.condition, end.condition}, x) && (x - end.x).norm() <= kNearEnd * s_.scale) {
      std::vector<int> faces = edge_faces(e);
      if (const std::optional<Star> star = s_.star(x, ChainTolerances::on_edge * s_.scale)) {
        for (const Wedge& wedge : star->wedges) faces.push_back(wedge.face);
      }
      corners_.push_back({x, joined(std::move(faces), {})});
      return x;
    }
    return end.x;
  }

  std::vector<Point3> walk(EdgeLine& line, const Point3& from, int sign) {
    std::vector<Point3> points{from};
    const double longest = kStep * graph_.size();
    double step = longest;
    for (int n = 0; n < kMostSteps; ++n) {
      const Point3 x = points.back();
      const Point3 t = s_.tangent(line.edge, x);
      EdgeWalk walk;
      for (;; step /= 2) {
        walk = walk_along(s_, line.edge, x, sign * step);
        if (walk.possible) {
          if (const EdgeCorner* corner = corner_within(line.edge, x, walk.x)) {
            points.push_back(corner->x);
            return points;
          }
          if (1 - s_.tangent(line.edge, walk.x).dot(t) <= kTurn) break;
        }
        if (step < kLeastStep * graph_.size()) {
          corners_.push_back({x, joined(edge_faces(line.edge), {}), true});
          return points;
        }
      }
      if (walk.end != 0) {
        points.push_back(new_corner(line.edge, walk));
        return points;
      }
      if (!graph_.box().contains(walk.x)) {
        points.push_back(walk.x);
        line.cut = true;
        return points;
      }
      // Around: the start lies within this step.
      const Point3 ahead = walk.x - x;
      const double u = (from - x).dot(ahead) / ahead.squaredNorm();
      if (n > 1 && u > 0 && u <= 1 && (x + u * ahead - from).norm() <= kPassed * graph_.size()) {
        points.push_back(from);
        line.closed = true;
        return points;
      }
      points.push_back(walk.x);
      step = std::min(longest, 2 * step);
    }
    line.cut = true;
    return points;
  }

  FacetedSurface& s_;
  const FacetGraph& graph_;
  std::vector<EdgeCorner>& corners_;
};

/// Where walks have passed, by the edge's faces.
class PassedLines {
 public:
  PassedLines(const FacetedSurface& surface, double reach) : s_(surface), reach_(reach) {}

  void add(const EdgeLine& line) { lines_[faces(line.edge)].push_back(&line.points); }

  [[nodiscard]] bool has(int edge, const Point3& x) const {
    const auto known = lines_.find(faces(edge));
    if (known == lines_.end()) return false;
    for (const std::vector<Point3>* points : known->second) {
      for (std::size_t i = 0; i + 1 < points->size(); ++i) {
        const Point3 along = (*points)[i + 1] - (*points)[i];
        const double size = along.squaredNorm();
        const double u = size > 0 ? std::clamp(along.dot(x - (*points)[i]) / size, 0.0, 1.0) : 0.0;
        if (((*points)[i] + u * along - x).norm() <= reach_) return true;
      }
    }
    return false;
  }

 private:
  [[nodiscard]] std::pair<int, int> faces(int edge) const { return {s_.edge(edge).a, s_.edge(edge).b}; }
  const FacetedSurface& s_;
  double reach_;
  std::map<std::pair<int, int>, std::vector<const std::vector<Point3>*>> lines_;
};

/// The arcs between marks; the polyline where they cannot be followed.
double length_of(FacetedSurface& surface, const EdgeLine& line) {
  double length = 0;
  for (std::size_t first = 0; first + 1 < line.points.size();) {
    const std::size_t last = std::min(first + kBetweenMarks, line.points.size() - 1);
    ChainArc arc;
    arc.edge = line.edge;
    arc.start.resize(3, static_cast<Index>(last - first + 1));
    for (std::size_t i = first; i <= last; ++i) arc.start.col(static_cast<Index>(i - first)) = line.points[i];
    if (trace_edge_arc(surface, arc, line.points[first], line.points[last])) {
      length += arc.length;
    } else {
      for (std::size_t i = first; i < last; ++i) length += (line.points[i + 1] - line.points[i]).norm();
    }
    first = last;
  }
  return length;
}

/// Inside the line, since faces may touch at its ends.
double angle_of(FacetedSurface& surface, const EdgeLine& line) {
  const SharpEdge edge = surface.edge(line.edge);
  if (edge.b < 0) return 0;
  double largest = 0;
  for (int look = 1; look <= kLooks; ++look) {
    const double at = static_cast<double>(look) / (kLooks + 1) * static_cast<double>(line.points.size() - 1);
    const auto i = static_cast<std::size_t>(at);
    Point3 x = line.points[i] + (at - static_cast<double>(i)) * (line.points[i + 1] - line.points[i]);
    if (!surface.project(edge.a, {edge.condition}, x)) x = line.points[i];
    Point3 a;
    Point3 b;
    (void)surface.function(edge.a, x, a);
    (void)surface.function(edge.b, x, b);
    largest = std::max(largest, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return largest;
}

/// Does the step between two points inside a face stay in it, as far as its middle tells.
bool stays_inside(FacetedSurface& surface, int face, const Point3& a, const Point3& b) {
  Point3 middle = (a + b) / 2;
  return surface.project(face, {}, middle) && surface.face_at(middle) == face;
}

/// Does it pass a point where patches of its face may touch: that joins them for steps, not for people.
bool passes_touching(const EdgeNetwork& network, const Point3& a, const Point3& b, double cell) {
  return std::any_of(network.corners.begin(), network.corners.end(), [&](const EdgeCorner& corner) {
    if (!corner.touching) return false;
    const double size = (b - a).squaredNorm();
    const double u = size > 0 ? std::clamp((b - a).dot(corner.x - a) / size, 0.0, 1.0) : 0.0;
    return (a + u * (b - a) - corner.x).norm() < kBesideTouching * cell;
  });
}

std::vector<int> count_patches(FacetedSurface& surface, const FacetGraph& graph, const EdgeNetwork& network) {
  const std::vector<FacetNode>& nodes = graph.nodes();
  std::vector<std::size_t> root(nodes.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const auto is_inner = [](const FacetNode& node) { return node.edge < 0 && !node.corner; };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_inner(nodes[i])) continue;
    const int face = nodes[i].faces.front();
    for (const FacetLink& link : graph.links(static_cast<std::uint32_t>(i))) {
      if (link.to < i || !is_inner(nodes[link.to]) || root_of(i) == root_of(link.to)) continue;
      if (passes_touching(network, nodes[i].x, nodes[link.to].x, graph.size())) continue;
      if (stays_inside(surface, face, nodes[i].x, nodes[link.to].x)) root[root_of(i)] = root_of(link.to);
    }
  }
  std::vector<std::set<std::size_t>> found(surface.known().faces);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (is_inner(nodes[i]) && !passes_touching(network, nodes[i].x, nodes[i].x, graph.size()))
      found[static_cast<std::size_t>(nodes[i].faces.front())].insert(root_of(i));
  }
  std::vector<int> counts;
  for (const std::set<std::size_t>& roots : found) counts.push_back(static_cast<int>(roots.size()));
  return counts;
}

}  // namespace

EdgeNetwork edge_network(FacetedSurface& surface, const FacetGraph& graph, const Context& context) {
  EdgeNetwork network;
  for (const FacetNode& node : graph.nodes()) {
    if (!node.corner || !is_corner(surface, node.x)) continue;
    const auto known = std::find_if(network.corners.begin(), network.corners.end(), [&](const EdgeCorner& corner) {
      return (corner.x - node.x).norm() <= kSameCorner * surface.scale;
    });
    if (known == network.corners.end()) {
      network.corners.push_back({node.x, node.faces});
    } else {
      known->faces = joined(known->faces, node.faces);
    }
  }
  EdgeFollower follower(surface, graph, network.corners);
  std::vector<std::unique_ptr<EdgeLine>> lines;
  PassedLines passed(surface, kPassed * graph.size());
  for (const FacetNode& node : graph.nodes()) {
    if (node.edge < 0 || passed.has(node.edge, node.x)) continue;
    context.check_cancelled();
    lines.push_back(std::make_unique<EdgeLine>(follower.follow(node.edge, node.x)));
    passed.add(*lines.back());
  }
  for (const std::unique_ptr<EdgeLine>& line : lines) {
    if (line->points.size() < 2) continue;
    line->length = length_of(surface, *line);
    line->angle = angle_of(surface, *line);
    network.lines.push_back(std::move(*line));
  }
  // Clones of the surface count faces on: only those that the graph has nodes of are there.
  network.patches = count_patches(surface, graph, network);
  return network;
}

}  // namespace taut::detail
