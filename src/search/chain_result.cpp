// From a broken geodesic to what people are told of it.
#include "search/chain_result.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "search/explain.hpp"

namespace taut::detail {
namespace {

/// Lengths are sums of arcs, each good to rounding.
constexpr double kRounding = 4e-16;

PathPiece piece_of(FacetedSurface& surface, const ChainArc& arc, const Point3& begin) {
  PathPiece piece;
  piece.kind = arc.face >= 0                  ? PathPiece::Kind::face
               : surface.edge(arc.edge).b < 0 ? PathPiece::Kind::border
                                              : PathPiece::Kind::edge;
  if (arc.face >= 0) piece.face = surface.face(arc.face).text;
  piece.length = arc.length;
  piece.point = begin;
  return piece;
}

PathPiece meeting_of(FacetedSurface& surface, const ChainStop& stop, const ChainArc& before) {
  PathPiece meeting;
  meeting.point = stop.x;
  if (stop.kind == ChainStop::Kind::corner) {
    meeting.kind = PathPiece::Kind::corner;
    meeting.left = stop.left;
    meeting.right = stop.right;
  } else {
    meeting.kind = PathPiece::Kind::crossing;
    const Point3 t = surface.tangent(stop.edge, stop.x);
    meeting.left = meeting.right = std::acos(std::clamp(std::abs(before.last.dot(t)), 0.0, 1.0));
  }
  return meeting;
}

}  // namespace

Points points_of(const FacetChain& chain, const Vector& from, const Vector& to) {
  Points points = chain.points();
  points.col(0) = from;
  points.col(points.cols() - 1) = to;
  return points;
}

double length_error_of(const FacetChain& chain) { return chain.error + kRounding * chain.length; }

void add_chain(FacetedSurface& surface, const FacetChain& chain, PathResult& result) {
  result.status = Status::ok;
  result.length = chain.length;
  result.length_error = length_error_of(chain);
  result.locally_shortest = chain.locally_shortest;
  result.index = chain.index;
  result.points = points_of(chain, result.from, result.to);
  result.start_direction = chain.arcs.front().first;
  result.end_direction = chain.arcs.back().last;
  result.num_iterations = chain.rounds;
  for (const ChainArc& arc : chain.arcs) {
    result.residual.surface = std::max(result.residual.surface, arc.residual.surface);
    result.residual.geodesic_curvature = std::max(result.residual.geodesic_curvature, arc.residual.geodesic_curvature);
    result.num_iterations += arc.iterations;
  }
  if (chain.closed && chain.stops.front().kind != ChainStop::Kind::contact) {
    result.pieces.push_back(meeting_of(surface, chain.stops.front(), chain.arcs.back()));
  }
  for (std::size_t i = 0; i < chain.arcs.size(); ++i) {
    result.pieces.push_back(piece_of(surface, chain.arcs[i], chain.stops[i].x));
    if (i + 1 == chain.arcs.size()) break;
    const ChainStop& stop = chain.stops[i + 1];
    if (stop.kind == ChainStop::Kind::contact) continue;
    result.pieces.push_back(meeting_of(surface, stop, chain.arcs[i]));
  }
}

void add_trouble(const ChainTrouble& trouble, double length, PathResult& result) {
  result.obstacle = {Obstacle::Kind::faces, trouble.place, length};
  result.reason = in_words(trouble.fault);
}

}  // namespace taut::detail
