// Broken geodesics on a surface made of faces: the loop of sliding and changing the row of arcs, and the last check.
//
// Stationary chains: at a crossing the tangents agree along the edge; where the path follows an edge it comes and
// leaves along it and is pressed against it; a corner has an angle of at least pi on either side.
#include "strata/shorten_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "curve/polyline.hpp"
#include "strata/arc_tracer.hpp"
#include "strata/chain_tolerances.hpp"
#include "strata/corner_turn.hpp"
#include "strata/edge_contact.hpp"
#include "strata/empty_arcs.hpp"
#include "strata/face_departure.hpp"
#include "strata/stop_newton.hpp"

namespace taut::detail {
namespace {

using Kind = ChainStop::Kind;
constexpr int kMostRounds = 60;
/// What the last check allows: differences of tangents where an edge is followed, which are known to the square root of
/// the step's rounding; angles of corners, radians; turns of a followed edge, of the model's size; and directions of
/// negative second variation, the same.
constexpr double kContactTangents = 1e-5;
constexpr double kCornerAngle = 1e-5;
constexpr double kPressed = 1e-6;
constexpr double kFalling = 1e-9;
/// A corner is as near to where Newton's method stopped at the end of an edge, of the model's size.
constexpr double kNearCorner = 1e-6;
constexpr double kAroundEnd = 1e-7;

constexpr const char* kNoGeodesic = "a geodesic on one face was not found";

/// The stop at the end of its edge becomes a corner: with the condition that fails beyond it, or one of those of the
/// edges that meet there.
ChainMove end_in_corner(FacetedSurface& surface, FacetChain& chain, const StopAtEnd& end) {
  ChainStop& stop = chain.stops[end.stop];
  const SharpEdge edge = surface.edge(stop.edge);
  std::vector<int> others{end.condition};
  if (const std::optional<Star> star = surface.star(stop.x, kAroundEnd * surface.scale)) {
    for (const Wedge& wedge : star->wedges) {
      others.push_back(wedge.first_condition);
      others.push_back(wedge.second_condition);
    }
  }
  for (const int other : others) {
    if (other < 0 || other == edge.condition) continue;
    Point3 x = stop.x;
    if (!surface.project(edge.a, {edge.condition, other}, x)) continue;
    if ((x - stop.x).norm() > kNearCorner * surface.scale) continue;
    const std::optional<Star> star = surface.star(x, ChainTolerances::on_edge * surface.scale);
    if (!star || (star->closed && star->wedges.size() < 3)) continue;
    stop.x = x;
    stop.kind = Kind::corner;
    chain.arcs[end.stop - 1].done = chain.arcs[end.stop].done = false;
    return {.changed = true};
  }
  return {.stuck = "a path runs over the end of an edge where no corner was found"};
}

/// An arc along an edge that runs backwards is none.
ChainMove drop_turned_arc(FacetChain& chain) {
  for (std::size_t i = 1; i + 1 < chain.arcs.size(); ++i) {
    const ChainArc& before = chain.arcs[i - 1];
    const ChainArc& arc = chain.arcs[i];
    const ChainArc& after = chain.arcs[i + 1];
    if (arc.face >= 0 || before.face < 0 || after.face < 0) continue;
    if (!(before.last.dot(arc.first) < 0 && after.first.dot(arc.last) < 0)) continue;
    const int face = before.face;
    if (after.face != face || chain.stops[i].kind != Kind::contact || chain.stops[i + 1].kind != Kind::contact) {
      return {.stuck = "an arc along an edge turns back"};
    }
    chain.stops.erase(chain.stops.begin() + static_cast<std::ptrdiff_t>(i));
    chain.arcs.erase(chain.arcs.begin() + static_cast<std::ptrdiff_t>(i));
    chain.arcs[i - 1].points = chord(chain.stops[i - 1].x, chain.stops[i].x);
    chain.join_arcs(i, face);
    return {.changed = true};
  }
  return {};
}

/// Looks for what a settled chain breaks, and mends one thing.
ChainMove mend(FacetedSurface& surface, FacetChain& chain, const SlidStops& slid, int& num_shifted,
               std::vector<FacetChain>& others) {
  if (drop_empty_arcs(chain, ChainTolerances::together * surface.scale)) return {.changed = true};
  if (!slid.at_end.empty()) return end_in_corner(surface, chain, slid.at_end.front());
  for (std::size_t i = 1; i + 1 < chain.stops.size(); ++i) {
    if (chain.stops[i].kind != Kind::corner) continue;
    FacetChain other = chain;
    const CornerTurn turn = leave_corner(surface, chain, i);
    if (!turn.left) continue;
    if (turn.both && leave_corner(surface, other, i, true).left) others.push_back(std::move(other));
    return {.changed = true};
  }
  ChainMove move = drop_turned_arc(chain);
  for (std::size_t i = 0; i < chain.arcs.size() && !move.changed && move.stuck.empty(); ++i) {
    move = keep_on_face(surface, chain, i, num_shifted);
  }
  return move;
}

/// What a settled chain breaks; empty: nothing.
std::string broken(FacetedSurface& surface, const FacetChain& chain) {
  for (std::size_t i = 1; i + 1 < chain.stops.size(); ++i) {
    const ChainStop& stop = chain.stops[i];
    const Point3 turn = chain.arcs[i - 1].last - chain.arcs[i].first;
    if (stop.kind == Kind::crossing) {
      if (std::abs(turn.dot(surface.tangent(stop.edge, stop.x))) > ChainTolerances::angle) {
        return "the tangents at an edge do not agree";
      }
    } else if (stop.kind == Kind::contact) {
      if (turn.norm() > kContactTangents) return "the path does not meet an edge that it follows along it";
    } else if (std::min(stop.left, stop.right) < std::numbers::pi - kCornerAngle) {
      return "the path passes a corner that it could go round";
    }
  }
  for (const ChainArc& arc : chain.arcs) {
    if (arc.face >= 0) continue;
    for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const auto j = static_cast<Index>(u * static_cast<double>(arc.points.cols() - 1));
      if (pressed(surface, arc.edge, arc.points.col(j)) > kPressed / surface.scale) {
        return "the path is not pressed against an edge that it follows";
      }
    }
  }
  return {};
}

}  // namespace

void shorten_chain(FacetedSurface& surface, FacetChain& chain, std::vector<FacetChain>& others,
                   const Context& context) {
  ArcTracer tracer(surface, context);
  const double together = ChainTolerances::together * surface.scale;
  int num_shifted = 0;
  bool followed = false;
  bool settled = false;
  double least_curvature = 0;
  for (chain.rounds = 0; chain.rounds < kMostRounds; ++chain.rounds) {
    do {
      if (!tracer.trace(chain)) {
        chain.why = kNoGeodesic;
        return;
      }
    } while (drop_empty_arcs(chain, together));
    const SlidStops slid = slide_stops(surface, tracer, chain, context);
    if (!slid.settled) {
      chain.why = slid.why;
      // Two crossings of an edge that the path is pressed against never settle: it follows the edge.
      if (followed || !follow_edges(surface, chain)) return;
      followed = true;
      chain.why.clear();
      continue;
    }
    least_curvature = slid.least_curvature;
    ChainMove move = mend(surface, chain, slid, num_shifted, others);
    if (!move.stuck.empty()) {
      chain.why = std::move(move.stuck);
      return;
    }
    settled = !move.changed;
    if (settled) break;
  }
  if (!settled) {
    chain.why = "the row of faces along the path does not settle";
    return;
  }
  bool shortest = true;
  chain.length = 0;
  for (const ChainArc& arc : chain.arcs) {
    chain.length += arc.length;
    chain.error += arc.error;
    shortest = shortest && arc.shortest;
  }
  chain.why = broken(surface, chain);
  if (!chain.why.empty()) return;
  chain.solved = true;
  chain.locally_shortest = shortest && !(least_curvature < -kFalling / surface.scale);
}

}  // namespace taut::detail
