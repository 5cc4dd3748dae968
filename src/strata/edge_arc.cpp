// The arc of a chain along an edge.
#include "strata/edge_arc.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "curve/polyline.hpp"
#include "strata/chain_tolerances.hpp"

namespace taut::detail {

/// Pieces of the edge between points of it, each a graph over its chord: the length by Gauss's rule.
bool trace_edge_arc(FacetedSurface& surface, ChainArc& arc, const Point3& a, const Point3& b) {
  const double together = ChainTolerances::together * surface.scale;
  const SharpEdge edge = surface.edge(arc.edge);
  std::vector<Point3> marks{a};
  // Marks that the ends have passed are left out.
  const Points& start = arc.start;
  const Index count = start.cols();
  if (count > 1) {
    Point3 ta = surface.tangent(arc.edge, a);
    Point3 tb = surface.tangent(arc.edge, b);
    if (ta.dot(Point3(start.col(1) - start.col(0))) < 0) ta = -ta;
    if (tb.dot(Point3(start.col(count - 1) - start.col(count - 2))) < 0) tb = -tb;
    constexpr double kAhead = 0.02;  // cosine
    for (Index i = 0; i < count; ++i) {
      const Point3 x = start.col(i);
      const double from_a = (x - a).norm();
      const double from_b = (x - b).norm();
      if (i < count / 2 && (x - a).dot(ta) <= kAhead * from_a + together) continue;
      if (i >= count / 2 && (b - x).dot(tb) <= kAhead * from_b + together) continue;
      marks.push_back(x);
    }
  }
  marks.push_back(b);
  // The more marks, the more pieces: one that is in line with its neighbours is not wanted.
  std::vector<Point3> kept{a};
  for (std::size_t i = 1; i + 1 < marks.size(); ++i) {
    const Point3 ahead = (marks[i + 1] - kept.back()).normalized();
    constexpr double kInLine = 0.99;  // cosine
    if (std::abs(surface.tangent(arc.edge, kept.back()).dot(ahead)) < kInLine ||
        std::abs(surface.tangent(arc.edge, marks[i + 1]).dot(ahead)) < kInLine) {
      kept.push_back(marks[i]);
    }
  }
  kept.push_back(b);
  marks = std::move(kept);
  // Abscissae and weights of Gauss's rule with 8 points on [0, 1].
  static constexpr double kNode[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  static constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  double length = 0;
  std::vector<Point3> line{a};
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    // Halved until the edge turns little.
    std::vector<std::pair<Point3, Point3>> open{{marks[i], marks[i + 1]}};
    int budget = 400;
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      const double chord_length = (to - from).norm();
      if (chord_length <= 1e-14 * surface.scale) continue;
      const Point3 e = (to - from) / chord_length;
      const double begin = std::abs(surface.tangent(arc.edge, from).dot(e));
      const double end = std::abs(surface.tangent(arc.edge, to).dot(e));
      Point3 middle = (from + to) / 2;
      const auto on_edge = [&](double u, Point3& x) {
        // The point of the edge in the plane across the chord at u.
        for (int step = 0; step < 30; ++step) {
          Point3 f;
          Point3 c;
          const double vf = surface.function(edge.a, x, f);
          const double vc = surface.condition(edge.condition, x, c);
          Eigen::Matrix3d j;
          j.row(0) = f.transpose() / f.norm();
          j.row(1) = c.transpose() / c.norm();
          j.row(2) = e.transpose();
          const Point3 r(vf / f.norm(), vc / c.norm(), (x - from).dot(e) - u * chord_length);
          const Point3 d = j.partialPivLu().solve(r);
          if (!d.allFinite()) return false;
          x -= d;
          if (d.norm() <= 1e-15 * surface.scale) return true;
        }
        return true;
      };
      if (!on_edge(0.5, middle)) return false;
      // The integrand's poles lie where the edge would be across the chord: eight points then reach 1e-15.
      constexpr double kStraight = 0.98;  // cos of 11 degrees
      const double mid = std::abs(surface.tangent(arc.edge, middle).dot(e));
      if (std::min({begin, end, mid}) < kStraight || (middle - (from + to) / 2).norm() > 0.1 * chord_length) {
        if (--budget < 0) return false;
        open.emplace_back(middle, to);
        open.emplace_back(from, middle);
        continue;
      }
      double sum = 0;
      for (int g = 0; g < 8; ++g) {
        const int node = g < 4 ? 3 - g : g - 4;  // from one end to the other
        const double u = 0.5 + (g < 4 ? -0.5 : 0.5) * kNode[node];
        Point3 x = from + u * (to - from) + 4 * u * (1 - u) * (middle - (from + to) / 2);
        if (!on_edge(u, x)) return false;
        line.push_back(x);
        sum += 0.5 * kWeight[node] / std::abs(surface.tangent(arc.edge, x).dot(e));
      }
      length += sum * chord_length;
      line.push_back(to);
    }
  }
  arc.length = length;
  arc.error = 1e-14 * length;
  arc.points.resize(3, static_cast<Index>(line.size()));
  for (std::size_t i = 0; i < line.size(); ++i) arc.points.col(static_cast<Index>(i)) = line[i];
  if (line.size() < 2) arc.points = chord(a, b);
  arc.first = surface.tangent(arc.edge, a);
  arc.last = surface.tangent(arc.edge, b);
  const Index m = arc.points.cols();
  if (arc.first.dot(Point3(arc.points.col(1) - arc.points.col(0))) < 0) arc.first = -arc.first;
  if (arc.last.dot(Point3(arc.points.col(m - 1) - arc.points.col(m - 2))) < 0) arc.last = -arc.last;
  return true;
}

}  // namespace taut::detail
