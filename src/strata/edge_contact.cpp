// Where a chain follows an edge.
#include "strata/edge_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "curve/polyline.hpp"
#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

/// Parts of an arc whose ends are brought to the edge.
constexpr Index kMarks = 24;
/// A pull that is rounding, of the model's size.
constexpr double kNoPull = 1e-9;

}  // namespace

EdgePull strongest_pull(FacetedSurface& surface, int e, const Point3& x) {
  const SharpEdge edge = surface.edge(e);
  const Point3 kappa = surface.curvature(e, x);
  const std::optional<Star> star = surface.star(x, 1e-7 * surface.scale);
  if (!star) return {std::numeric_limits<double>::infinity(), -1};
  EdgePull most{-std::numeric_limits<double>::infinity(), -1};
  for (const Wedge& wedge : star->wedges) {
    if (wedge.face != edge.a && wedge.face != edge.b) continue;
    const Point3 inwards = wedge.normal.cross(wedge.first);
    const double curvature = kappa.dot(inwards);
    if (curvature > most.curvature) most = {curvature, wedge.face};
  }
  return most;
}

bool follow_edges(FacetedSurface& surface, FacetChain& chain) {
  bool found = false;
  for (std::size_t i = 1; i + 1 < chain.arcs.size(); ++i) {
    ChainArc& arc = chain.arcs[i];
    ChainStop& a = chain.stops[i];
    ChainStop& b = chain.stops[i + 1];
    if (arc.face < 0 || a.kind != ChainStop::Kind::crossing || b.kind != ChainStop::Kind::crossing || a.edge != b.edge)
      continue;
    const SharpEdge edge = surface.edge(a.edge);
    std::vector<Point3> marks;
    const Points line = at_equal_parts(arc.points, kMarks);
    for (Index j = 0; j < line.cols(); ++j) {
      Point3 x = line.col(j);
      if (surface.project(edge.a, {edge.condition}, x)) marks.push_back(x);
    }
    if (marks.size() < 2 ||
        strongest_pull(surface, a.edge, marks[marks.size() / 2]).curvature > kNoPull / surface.scale)
      continue;
    ChainArc along;
    along.edge = a.edge;
    along.start.resize(3, static_cast<Index>(marks.size()));
    for (std::size_t k = 0; k < marks.size(); ++k) along.start.col(static_cast<Index>(k)) = marks[k];
    arc = std::move(along);
    a.kind = b.kind = ChainStop::Kind::contact;
    found = true;
  }
  return found;
}

bool lift_from_edge(FacetedSurface& surface, FacetChain& chain, std::size_t i) {
  const ChainArc arc = chain.arcs[i];
  const Index n = arc.points.cols();
  if (arc.face >= 0 || n < 2) return false;
  // The first part that the same face pulls at, from point `first` to `last`.
  Index first = n;
  Index last = -1;
  int face = -1;
  for (Index j = 0; j < n; ++j) {
    const EdgePull pull = strongest_pull(surface, arc.edge, arc.points.col(j));
    const bool pulled = pull.face >= 0 && pull.curvature > ChainTolerances::pressed / surface.scale;
    if (pulled && (face < 0 || pull.face == face)) {
      first = std::min(first, j);
      last = j;
      face = pull.face;
    } else if (face >= 0) {
      break;
    }
  }
  if (face < 0) return false;
  // To the points beside it, so that it has a length.
  first = std::max<Index>(first - 1, 0);
  last = std::min(last + 1, n - 1);
  std::vector<ChainStop> between;
  std::vector<ChainArc> parts;
  const auto add_part = [&](Index from, Index to, bool along_edge) {
    ChainArc part;
    (along_edge ? part.edge : part.face) = along_edge ? arc.edge : face;
    part.points = part.start = arc.points.middleCols(from, to - from + 1);
    parts.push_back(std::move(part));
  };
  if (first > 0) {
    add_part(0, first, true);
    between.push_back({.kind = ChainStop::Kind::contact, .x = arc.points.col(first), .edge = arc.edge});
  }
  add_part(first, last, false);
  if (last < n - 1) {
    between.push_back({.kind = ChainStop::Kind::contact, .x = arc.points.col(last), .edge = arc.edge});
    add_part(last, n - 1, true);
  }
  const std::size_t num_parts = parts.size();
  chain.replace_arc(i, std::move(between), std::move(parts));
  // At the ends of the arc it was: the arc next to it comes over the same face, or crosses.
  const auto meet = [&](std::size_t stop) {
    if (stop >= chain.arcs.size() || chain.stops[stop].kind != ChainStop::Kind::contact) return;
    if (chain.before(stop).face == chain.arcs[stop].face) {
      chain.join_arcs(stop, face);
    } else {
      chain.stops[stop].kind = ChainStop::Kind::crossing;
    }
  };
  if (last == n - 1) meet(i + num_parts);
  if (first == 0) meet(i);
  return true;
}

}  // namespace taut::detail
