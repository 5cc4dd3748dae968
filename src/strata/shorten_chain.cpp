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
#include "strata/closed_chain.hpp"
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
/// the step's rounding; angles of corners, radians.
constexpr double kContactTangents = 1e-5;
constexpr double kCornerAngle = 1e-5;
/// Second variations that are smaller, of the model's size, are neutral: Jacobi fields are good to some 1e-6.
constexpr double kFalling = 1e-5;
/// A corner is as near to where Newton's method stopped at the end of an edge, of the model's size.
constexpr double kNearCorner = 1e-6;
constexpr double kAroundEnd = 1e-7;

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
    chain.before(end.stop).done = chain.arcs[end.stop].done = false;
    return {.changed = true};
  }
  return {.stuck = {ChainFault::no_corner, stop.x}};
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
      return {.stuck = {ChainFault::turned_arc, chain.stops[i].x}};
    }
    chain.stops.erase(chain.stops.begin() + static_cast<std::ptrdiff_t>(i));
    chain.arcs.erase(chain.arcs.begin() + static_cast<std::ptrdiff_t>(i));
    chain.arcs[i - 1].points = chord(chain.stops[i - 1].x, chain.stops[i].x);
    chain.join_arcs(i, face);
    return {.changed = true};
  }
  return {};
}

/// A closed chain begins where its row of arcs needs no change: away from short arcs, in a crossing rather than in a
/// contact, there rather than in a corner, and in none of `not_these`. False where there is no such stop.
bool choose_seam(FacetedSurface& surface, FacetChain& chain, const std::vector<StopAtEnd>& not_these) {
  const auto rank = [](Kind kind) { return kind == Kind::crossing ? 2 : kind == Kind::contact ? 1 : 0; };
  std::size_t best = chain.stops.size();
  std::pair<int, double> most;
  for (std::size_t i = 0; i < chain.end_inner(); ++i) {
    if (std::any_of(not_these.begin(), not_these.end(), [&](const StopAtEnd& end) { return end.stop == i; })) continue;
    const double room = std::min(chain.before(i).length, chain.arcs[i].length);
    if (!(room > ChainTolerances::together * surface.scale)) continue;
    const std::pair<int, double> value{rank(chain.stops[i].kind), room};
    if (best < chain.stops.size() && !(value > most)) continue;
    best = i;
    most = value;
  }
  if (best == chain.stops.size()) return false;
  begin_at(chain, best);
  return true;
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
  for (std::size_t i = 0; i < chain.arcs.size() && !move.changed && move.stuck.fault == ChainFault::none; ++i) {
    move.changed = lift_from_edge(surface, chain, i);
  }
  for (std::size_t i = 0; i < chain.arcs.size() && !move.changed && move.stuck.fault == ChainFault::none; ++i) {
    move = keep_on_face(surface, chain, i, false, num_shifted);
  }
  // What is about to be believed is looked at closely.
  if (surface.surface().domain() == nullptr) return move;
  for (std::size_t i = 0; i < chain.arcs.size() && !move.changed && move.stuck.fault == ChainFault::none; ++i) {
    move = keep_on_face(surface, chain, i, true, num_shifted);
  }
  return move;
}

/// What a settled chain breaks.
ChainTrouble broken(FacetedSurface& surface, const FacetChain& chain) {
  for (std::size_t i = chain.first_inner(); i < chain.end_inner(); ++i) {
    const ChainStop& stop = chain.stops[i];
    const Point3 turn = chain.before(i).last - chain.arcs[i].first;
    if (stop.kind == Kind::crossing) {
      if (std::abs(turn.dot(surface.tangent(stop.edge, stop.x))) > ChainTolerances::angle) {
        return {ChainFault::bent_crossing, stop.x};
      }
    } else if (stop.kind == Kind::contact) {
      if (turn.norm() > kContactTangents) return {ChainFault::bent_contact, stop.x};
    } else if (std::min(stop.left, stop.right) < std::numbers::pi - kCornerAngle) {
      return {ChainFault::corner_with_room, stop.x};
    }
  }
  for (const ChainArc& arc : chain.arcs) {
    if (arc.face >= 0) continue;
    for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const auto j = static_cast<Index>(u * static_cast<double>(arc.points.cols() - 1));
      if (strongest_pull(surface, arc.edge, arc.points.col(j)).curvature > ChainTolerances::pressed / surface.scale) {
        return {ChainFault::not_pressed, arc.points.col(j)};
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
  for (chain.rounds = 0; chain.rounds < kMostRounds; ++chain.rounds) {
    do {
      if (!tracer.trace(chain)) {
        chain.trouble = {ChainFault::no_arc, chain.stops[tracer.lost()].x};
        return;
      }
      if (chain.closed && !choose_seam(surface, chain, {})) {
        chain.trouble = {ChainFault::contracted, chain.stops.front().x};
        return;
      }
    } while (drop_empty_arcs(chain, together));
    SlidStops slid = slide_stops(surface, tracer, chain, context);
    if (!slid.settled) {
      chain.trouble = slid.trouble;
      // Two crossings of an edge that the path is pressed against never settle: it follows the edge.
      if (followed || !follow_edges(surface, chain)) return;
      followed = true;
      chain.trouble = {};
      continue;
    }
    if (chain.closed) {
      const std::vector<StopAtEnd> at_end = std::exchange(slid.at_end, {});
      std::vector<Point3> places;
      for (const StopAtEnd& end : at_end) places.push_back(chain.stops[end.stop].x);
      if (!choose_seam(surface, chain, at_end)) {
        chain.trouble = {ChainFault::contracted, chain.stops.front().x};
        return;
      }
      for (std::size_t k = 0; k < places.size(); ++k) {
        const auto there = std::find_if(chain.stops.begin() + 1, chain.stops.end() - 1,
                                        [&](const ChainStop& stop) { return stop.x == places[k]; });
        if (there == chain.stops.end() - 1) continue;
        slid.at_end.push_back({static_cast<std::size_t>(there - chain.stops.begin()), at_end[k].condition});
      }
    }
    const ChainMove move = mend(surface, chain, slid, num_shifted, others);
    if (move.stuck.fault != ChainFault::none) {
      chain.trouble = move.stuck;
      return;
    }
    settled = !move.changed;
    if (settled) break;
  }
  if (!settled) {
    chain.trouble = {ChainFault::unsettled_row, chain.stops[chain.stops.size() / 2].x};
    return;
  }
  bool shortest = true;
  chain.length = 0;
  for (const ChainArc& arc : chain.arcs) {
    chain.length += arc.length;
    chain.error += arc.error;
    shortest = shortest && arc.shortest;
  }
  chain.trouble = broken(surface, chain);
  if (chain.trouble.fault != ChainFault::none) return;
  chain.solved = true;
  const Vector rises = second_variation(surface, chain);
  for (const ChainArc& arc : chain.arcs) chain.index += arc.face >= 0 ? arc.index : 0;
  chain.index += static_cast<int>((rises.array() < -kFalling / surface.scale).count());
  chain.neutral = static_cast<int>((rises.array().abs() <= kFalling / surface.scale).count());
  chain.locally_shortest = shortest && chain.index == 0;
}

std::vector<FacetChain> shorten_with_others(FacetedSurface& surface, FacetChain chain, const Context& context) {
  // Each corner passed on its other side may come to further ones.
  constexpr std::size_t kMostOthers = 6;
  std::vector<FacetChain> chains{std::move(chain)};
  for (std::size_t i = 0; i < chains.size() && i <= kMostOthers; ++i) {
    std::vector<FacetChain> others;
    shorten_chain(surface, chains[i], others, context);
    for (FacetChain& other : others) chains.push_back(std::move(other));
  }
  chains.resize(std::min(chains.size(), kMostOthers + 1));  // the rest were not looked at
  return chains;
}

}  // namespace taut::detail
