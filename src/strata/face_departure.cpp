// An arc is a geodesic of its face's zero set, which goes on where the face ends. What lies beyond says over which
// edges it went:
//   1. several, one after the other: corners between them reach into the face, and the path bends there;
//   2. one, next to a crossing of the same edge that should be elsewhere: the crossing is moved there;
//   3. one that the path is pressed against: it is followed, from contact to contact;
//   4. one that it is not pressed against: it is crossed, out and back.
#include "strata/face_departure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "curve/looks_at_border.hpp"
#include "curve/polyline.hpp"
#include "strata/chain_tolerances.hpp"
#include "strata/edge_contact.hpp"

namespace taut::detail {
namespace {

using Kind = ChainStop::Kind;
/// Parts of an arc that are looked at.
constexpr Index kParts = 64;
/// Crossings moved to the other side of their edge in one chain, before the path is made to follow the edge.
constexpr int kMostShifts = 4;
/// Turns of a path that are rounding, of the model's size: less presses against an edge.
constexpr double kPressed = 1e-9;

ChainMove stuck(ChainFault fault, const Point3& place) { return {.stuck = {fault, place}}; }

/// The part of an arc beyond its face.
struct Departure {
  Points line;                 // points along the arc
  std::vector<int> condition;  // that fails at each; -1: none, or none is known
  Index first = -1;
  Index last = -1;  // of the first part that is outside
  double deepest = 0;
};

Departure departure_along(FacetedSurface& surface, int face, Points line) {
  Departure found;
  found.line = std::move(line);
  found.condition.assign(static_cast<std::size_t>(found.line.cols()), -1);
  for (const Index j : surface.not_inside(face, found.line)) {
    const Point3 x = found.line.col(j);
    const double out = surface.violation(face, x, &found.condition[static_cast<std::size_t>(j)]);
    if (!(out > ChainTolerances::off_face * surface.scale)) continue;
    if (found.first < 0) found.first = j;
    if (found.last < 0 || found.last == j - 1) {
      found.last = j;
      found.deepest = std::max(found.deepest, out);
    }
  }
  return found;
}

/// An obstacle may be smaller than the parts that are looked at.
Departure departure_of(FacetedSurface& surface, const ChainArc& arc, bool closely) {
  const Points line = arc.line.cols() > 0 ? arc.line : at_equal_parts(arc.points, kParts);
  if (!closely) return departure_along(surface, arc.face, line);
  return departure_along(surface, arc.face,
                         looks_at_border(surface.surface(), *surface.face(arc.face).evaluator, line));
}

/// Bends arc i in the corners between the edges of `row`: (place on the line, condition).
ChainMove bend_in_corners(FacetedSurface& surface, FacetChain& chain, std::size_t i, const Points& line,
                          const std::vector<std::pair<Index, int>>& row) {
  const int face = chain.arcs[i].face;
  std::vector<ChainStop> corners;
  std::vector<ChainArc> parts;
  Point3 from = chain.stops[i].x;
  for (std::size_t k = 1; k <= row.size(); ++k) {
    Point3 to = chain.stops[i + 1].x;
    if (k < row.size()) {
      to = line.col(row[k].first);
      if (!surface.project(face, {row[k - 1].second, row[k].second}, to) ||
          surface.violation(face, to) > ChainTolerances::on_edge * surface.scale) {
        return stuck(ChainFault::no_reflex_corner, to);
      }
      corners.push_back({.kind = Kind::corner, .x = to});
    }
    ChainArc part;
    part.face = face;
    part.start = chord(from, to);
    parts.push_back(std::move(part));
    from = to;
  }
  chain.replace_arc(i, std::move(corners), std::move(parts));
  return {.changed = true};
}

/// Moves the crossing at the start (or end) of arc i to where the arc first meets the edge, at the marks' near end.
void shift_crossing(FacetChain& chain, std::size_t i, bool at_end, const std::vector<Point3>& marks) {
  ChainArc& arc = chain.arcs[i];
  ChainArc& beyond = at_end ? chain.arcs[i + 1] : chain.arcs[i - 1];
  Points joined(3, static_cast<Index>(marks.size()) + beyond.points.cols());
  for (std::size_t k = 0; k < marks.size(); ++k) {
    joined.col(at_end ? static_cast<Index>(k) : beyond.points.cols() + static_cast<Index>(k)) = marks[k];
  }
  if (at_end) {
    joined.rightCols(beyond.points.cols()) = beyond.points;
  } else {
    joined.leftCols(beyond.points.cols()) = beyond.points;
  }
  beyond.start = without_repeats(joined);
  beyond.done = false;
  chain.stops[at_end ? i + 1 : i].x = at_end ? marks.front() : marks.back();
  arc.start = at_end ? chord(chain.stops[i].x, marks.front()) : chord(marks.back(), chain.stops[i + 1].x);
  arc.done = false;
}

}  // namespace

ChainMove keep_on_face(FacetedSurface& surface, FacetChain& chain, std::size_t i, bool closely, int& num_shifted) {
  ChainArc& arc = chain.arcs[i];
  if (arc.face < 0 || arc.length <= ChainTolerances::together * surface.scale) return {};
  const int face = arc.face;
  const Departure out = departure_of(surface, arc, closely);
  if (out.first < 0) return {};
  const auto condition_at = [&](Index j) { return out.condition[static_cast<std::size_t>(j)]; };
  const int enter = condition_at(out.first);
  if (!std::isfinite(out.deepest) || enter < 0 || condition_at(out.last) < 0) {
    return stuck(ChainFault::no_edge, out.line.col(out.first));
  }
  // The edges it passes beyond, in order: over the corners between them, which reach into the face.
  std::vector<std::pair<Index, int>> row;
  for (Index j = out.first; j <= out.last; ++j) {
    const int c = condition_at(j);
    if (c >= 0 && (row.empty() || row.back().second != c)) row.emplace_back(j, c);
  }
  if (row.size() > 1) return bend_in_corners(surface, chain, i, out.line, row);

  // One edge, out and back. Its points: where the way over the graph touched it, which tells the side; else where the
  // arc passes beyond.
  std::vector<Point3> marks;
  int edge = -1;
  for (std::size_t k = 0; k < arc.guide.size(); ++k) {
    const int touched = arc.guide_edges[k];
    if (touched < 0 || surface.edge(touched).condition != enter) continue;
    if (surface.edge(touched).a != face && surface.edge(touched).b != face) continue;
    edge = touched;
    marks.push_back(arc.guide[k]);
  }
  if (marks.size() < 2) {
    marks.clear();
    for (Index j = std::max<Index>(out.first - 1, 0); j <= std::min(out.last + 1, out.line.cols() - 1); ++j) {
      Point3 x = out.line.col(j);
      if (surface.project(face, {enter}, x)) marks.push_back(x);
    }
  }
  if (marks.size() < 2) return stuck(ChainFault::no_edge, out.line.col(out.first));
  const Point3 a = marks.front();
  const Point3 b = marks.back();
  const Point3 middle = marks[marks.size() / 2];
  if (edge < 0) {
    const std::optional<Star> star = surface.star(middle, 1e-8 * surface.scale);
    if (!star) return stuck(ChainFault::singular, middle);
    for (const Wedge& wedge : star->wedges) {
      if (wedge.face == face && wedge.second_edge >= 0) edge = wedge.second_edge;
    }
  }
  if (edge < 0) return stuck(ChainFault::no_edge, middle);
  const SharpEdge over = surface.edge(edge);
  const int other = over.a == face ? over.b : over.a;
  const bool follows = other < 0 || strongest_pull(surface, edge, middle).curvature <= kPressed / surface.scale;
  // Next to a crossing of the same edge, the path comes to the edge, or leaves it, on the face beyond.
  const auto crosses = [&](std::size_t stop) {
    const bool inner = stop > 0 && stop + 1 < chain.stops.size();
    return inner && follows && chain.stops[stop].kind == Kind::crossing && chain.stops[stop].edge == edge;
  };
  const bool from_beyond = crosses(i);
  const bool to_beyond = crosses(i + 1);
  if ((from_beyond || to_beyond) && num_shifted < kMostShifts) {
    ++num_shifted;
    shift_crossing(chain, i, to_beyond, marks);
    return {.changed = true};
  }
  ChainArc between;
  if (follows) {
    between.edge = edge;
    between.start.resize(3, static_cast<Index>(marks.size()));
    for (std::size_t k = 0; k < marks.size(); ++k) between.start.col(static_cast<Index>(k)) = marks[k];
  } else {
    between.face = other;
    between.start = chord(a, b);
  }
  const Kind kind = follows ? Kind::contact : Kind::crossing;
  std::vector<ChainStop> stops;
  std::vector<ChainArc> arcs;
  const auto add_face_arc = [&](const Point3& from, const Point3& to) {
    ChainArc part;
    part.face = face;
    part.start = chord(from, to);
    arcs.push_back(std::move(part));
  };
  if (from_beyond) {
    chain.stops[i].kind = Kind::contact;
  } else {
    stops.push_back({.kind = kind, .x = a, .edge = edge});
    add_face_arc(chain.stops[i].x, a);
  }
  arcs.push_back(std::move(between));
  if (to_beyond) {
    chain.stops[i + 1].kind = Kind::contact;
  } else {
    stops.push_back({.kind = kind, .x = b, .edge = edge});
    add_face_arc(b, chain.stops[i + 1].x);
  }
  chain.replace_arc(i, std::move(stops), std::move(arcs));
  return {.changed = true};
}

}  // namespace taut::detail
