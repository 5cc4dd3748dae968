// Shortening a chain at a corner.
#include "strata/corner_turn.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "curve/polyline.hpp"
#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

/// Stop i is in a corner: leaves it on the side where there is room. True when it did.
CornerTurn leave_corner(FacetedSurface& surface, FacetChain& chain, std::size_t i, bool wider_side) {
  ChainStop& stop = chain.stops[i];
  const ChainArc before = chain.arcs[i - 1];
  const ChainArc after = chain.arcs[i];
  const std::optional<Star> found = surface.star(stop.x, 1e-8 * surface.scale);
  stop.left = stop.right = kFar;
  if (!found) {
    // Not known to be a corner that may be passed.
    stop.left = stop.right = 0;
    return {};
  }
  const Star& star = *found;
  const std::size_t n = star.wedges.size();
  // Where a direction lies: the wedge and the angle in it. Directions along rays are in both wedges.
  struct Place {
    std::size_t wedge = 0;
    double angle = 0;
    double off = kFar;
  };
  const auto locate = [&](const Point3& v, int face) {
    Place best;
    for (std::size_t w = 0; w < n; ++w) {
      const Wedge& wedge = star.wedges[w];
      if (face >= 0 && wedge.face != face) continue;
      double angle = 0;
      double beyond = 0;
      if (wedge.angle > 6.28) {
        angle = 0;
      } else {
        const Point3 across_first = wedge.normal.cross(wedge.first);
        angle = std::atan2(v.dot(across_first), v.dot(wedge.first));
        // Of an angle outside, the nearer end.
        if (angle < -1e-12) {
          const double over = angle + 2 * kPi - wedge.angle;
          if (over > 0 && over < -angle) {
            beyond = over;
            angle = wedge.angle;
          } else if (over > 0) {
            beyond = -angle;
            angle = 0;
          } else {
            angle += 2 * kPi;
          }
        } else if (angle > wedge.angle) {
          const double over = angle - wedge.angle;
          const double under = 2 * kPi - angle;
          beyond = std::min(over, under);
          angle = over <= under ? wedge.angle : 0;
        }
      }
      const double off = beyond + std::abs(v.dot(wedge.normal));
      if (off < best.off) best = {w, angle, off};
    }
    return best;
  };
  const Place back = locate(-before.last, before.face);
  const Place ahead = locate(after.first, after.face);
  if (back.off > 0.1 || ahead.off > 0.1) {
    stop.left = stop.right = 0;
    return {};
  }
  struct Ray {
    double angle;  // from the start of the sweep
    int edge;
    int face_after;
  };
  // Sweeps counterclockwise from one place to the other.
  const auto sweep = [&](const Place& from, const Place& to, std::vector<Ray>& rays) {
    rays.clear();
    if (from.wedge == to.wedge && to.angle >= from.angle) return to.angle - from.angle;
    if (n == 1 && star.wedges.front().angle > 6.28) return kFar;
    double angle = star.wedges[from.wedge].angle - from.angle;
    std::size_t w = from.wedge;
    for (std::size_t k = 0; k < n; ++k) {
      if (w + 1 == n && !star.closed) return kFar;
      const int edge = star.wedges[w].second_edge;
      w = (w + 1) % n;
      rays.push_back({angle, edge, star.wedges[w].face});
      if (w == to.wedge) return angle + to.angle;
      angle += star.wedges[w].angle;
    }
    return kFar;
  };
  // Counterclockwise about the outer normal from the way ahead to the way back is the left side.
  std::vector<Ray> left;
  std::vector<Ray> right;
  stop.left = sweep(ahead, back, left);
  stop.right = sweep(back, ahead, right);
  const auto has_room = [](double angle) { return angle < kPi - ChainTolerances::angle; };
  const bool both = has_room(stop.left) && has_room(stop.right);
  if (!has_room(std::min(stop.left, stop.right)) || (wider_side && !both)) return {};
  const bool on_right = (stop.right <= stop.left) != wider_side;
  std::vector<Ray> rays = on_right ? right : left;
  const double whole = on_right ? stop.right : stop.left;
  if (!on_right) {
    // Seen from the way back.
    std::reverse(rays.begin(), rays.end());
    for (std::size_t k = 0; k < rays.size(); ++k) {
      rays[k].angle = whole - rays[k].angle;
    }
    // The face after a ray, going the other way, is the one before it.
    for (Ray& ray : rays) {
      const SharpEdge& edge = surface.edge(ray.edge);
      ray.face_after = ray.face_after == edge.a ? edge.b : edge.a;
    }
  }
  // Where the straight line of the unfolded faces crosses the rays.
  const double reach = std::min(before.length, after.length);
  const double p = std::max(reach, 0.5 * before.length);
  const double q = std::max(reach, 0.5 * after.length);
  std::vector<ChainStop> stops;
  std::vector<ChainArc> arcs;
  Point3 last = chain.stops[i - 1].x;
  int face = before.face >= 0 ? before.face : star.wedges[back.wedge].face;
  for (const Ray& ray : rays) {
    double r = p * q * std::sin(whole) / (p * std::sin(ray.angle) + q * std::sin(whole - ray.angle));
    if (!(r > 0)) r = 1e-3 * reach;
    // A ray in line with an end has nowhere to go: its crossing begins near the corner.
    r = std::min(r, 0.5 * reach);
    // The edge's direction away from the corner.
    Point3 away = surface.tangent(ray.edge, stop.x);
    for (const Wedge& wedge : star.wedges) {
      const Point3* direction = wedge.second_edge == ray.edge  ? &wedge.second
                                : wedge.first_edge == ray.edge ? &wedge.first
                                                               : nullptr;
      if (direction == nullptr) continue;
      if (away.dot(*direction) < 0) away = -away;
      break;
    }
    const double sign = surface.tangent(ray.edge, stop.x).dot(away) < 0 ? -1 : 1;
    ChainStop crossing;
    crossing.kind = ChainStop::Kind::crossing;
    crossing.edge = ray.edge;
    const SharpEdge edge = surface.edge(ray.edge);
    bool placed = false;
    for (int halving = 0; halving < 30 && !placed; ++halving, r /= 2) {
      crossing.x = stop.x;
      placed = surface.move(ray.edge, sign * r, crossing.x) &&
               surface.violation(edge.a, crossing.x) <= ChainTolerances::on_edge * surface.scale &&
               (edge.b < 0 || surface.violation(edge.b, crossing.x) <= ChainTolerances::on_edge * surface.scale);
    }
    if (!placed) return {};
    ChainArc arc;
    arc.face = face;
    arc.start = chord(last, crossing.x);
    arcs.push_back(std::move(arc));
    last = crossing.x;
    face = ray.face_after;
    stops.push_back(crossing);
  }
  ChainArc arc;
  arc.face = face;
  arc.start = chord(last, chain.stops[i + 1].x);
  arcs.push_back(std::move(arc));
  // Long arcs begin from what they were.
  const auto blend = [&](ChainArc& to, const ChainArc& old) {
    if (to.face == old.face && old.points.cols() > 2) to.start = old.points;
  };
  if (arcs.size() > 1) {
    blend(arcs.front(), before);
    blend(arcs.back(), after);
  } else if (before.points.cols() > 1 && after.points.cols() > 1) {
    Points joined(3, before.points.cols() + after.points.cols() - 1);
    joined << before.points, after.points.rightCols(after.points.cols() - 1);
    arcs.front().start = without_repeats(joined);
  }
  const auto at = static_cast<std::ptrdiff_t>(i);
  chain.stops.erase(chain.stops.begin() + at);
  chain.arcs.erase(chain.arcs.begin() + at);
  chain.replace_arc(i - 1, std::move(stops), std::move(arcs));
  return {.left = true, .both = both};
}

}  // namespace taut::detail
