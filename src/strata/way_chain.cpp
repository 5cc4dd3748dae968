// From a way over the graph to a chain: arcs on the faces that neighbouring points share, stops where they change.
#include "strata/way_chain.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "strata/chain_tolerances.hpp"

namespace taut::detail {

FacetChain chain_of(FacetedSurface& surface, const FacetWay& way) {
  FacetChain chain;
  const std::size_t steps = way.faces.size();
  chain.stops.push_back({.kind = ChainStop::Kind::end, .x = way.points.front()});
  std::vector<Point3> points{way.points.front()};
  std::vector<int> edges{way.edge.front()};
  std::vector<int> current;
  const auto close = [&](ChainStop stop) {
    ChainArc arc;
    arc.face = current.empty() ? -1 : current.front();
    arc.start.resize(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) arc.start.col(static_cast<Index>(i)) = points[i];
    arc.guide = points;
    arc.guide_edges = edges;
    chain.arcs.push_back(std::move(arc));
    chain.stops.push_back(std::move(stop));
  };
  for (std::size_t i = 0; i < steps; ++i) {
    const Point3& at = way.points[i];
    std::vector<int> both;
    for (const int face : way.faces[i]) {
      if (current.empty() || std::find(current.begin(), current.end(), face) != current.end()) both.push_back(face);
    }
    const bool corner = i > 0 && way.corner[i];
    if (both.empty() || (corner && !current.empty())) {
      ChainStop stop;
      stop.x = at;
      stop.kind = way.corner[i] || way.edge[i] < 0 ? ChainStop::Kind::corner : ChainStop::Kind::crossing;
      stop.edge = way.edge[i];
      close(stop);
      points = {at};
      edges = {way.edge[i]};
      both = way.faces[i];
    }
    current = std::move(both);
    // Corners that reach into the face, beside the way: the path may bend there. Those that it does not need are left
    // again.
    bool bent = false;
    for (const ReflexCorner& reflex : way.reflex) {
      if (reflex.step != i) continue;
      const auto face = std::find_if(current.begin(), current.end(), [&](int f) {
        return std::find(reflex.faces.begin(), reflex.faces.end(), f) != reflex.faces.end();
      });
      if (face == current.end()) continue;
      current = {*face};
      points.push_back(reflex.x);
      edges.push_back(-1);
      close({.kind = ChainStop::Kind::corner, .x = reflex.x});
      points = {reflex.x};
      edges = {-1};
      bent = true;
    }
    // From one edge of a face to the next: perhaps over the corner between them, which steps of the graph may cut.
    const int e = way.edge[i];
    const int f = way.edge[i + 1];
    if (!bent && i > 0 && i + 1 < steps && e >= 0 && f >= 0 && e != f) {
      const int face = current.front();
      const Point3 to = way.points[i + 1];
      Point3 x = (at + to) / 2;
      const SharpEdge one = surface.edge(e);
      const SharpEdge two = surface.edge(f);
      const auto of_face = [&](const SharpEdge& edge) { return edge.a == face || edge.b == face; };
      if (of_face(one) && of_face(two) && one.condition != two.condition &&
          surface.project(face, {one.condition, two.condition}, x) && (x - at).norm() < (to - at).norm() &&
          (x - to).norm() < (to - at).norm() &&
          surface.violation(face, x) <= ChainTolerances::on_edge * surface.scale) {
        points.push_back(x);
        edges.push_back(-1);
        ChainStop stop;
        stop.x = x;
        stop.kind = ChainStop::Kind::corner;
        close(stop);
        points = {x};
        edges = {-1};
      }
    }
    points.push_back(way.points[i + 1]);
    edges.push_back(way.edge[i + 1]);
  }
  close({.kind = ChainStop::Kind::end, .x = way.points.back()});
  return chain;
}

}  // namespace taut::detail
