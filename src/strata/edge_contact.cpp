// Where a chain follows an edge.
#include "strata/edge_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

/// Parts of an arc whose ends are brought to the edge.
constexpr Index kMarks = 24;

}  // namespace

double pressed(FacetedSurface& surface, int e, const Point3& x) {
  const SharpEdge edge = surface.edge(e);
  const Point3 kappa = surface.curvature(e, x);
  double most = -std::numeric_limits<double>::infinity();
  const std::optional<Star> star = surface.star(x, 1e-7 * surface.scale);
  if (!star) return std::numeric_limits<double>::infinity();
  for (const Wedge& wedge : star->wedges) {
    if (wedge.face != edge.a && wedge.face != edge.b) continue;
    const Point3 ray = wedge.first;
    const Point3 inwards = wedge.normal.cross(ray);
    most = std::max(most, kappa.dot(inwards));
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
    if (marks.size() < 2 || pressed(surface, a.edge, marks[marks.size() / 2]) > 1e-9 / surface.scale) continue;
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

}  // namespace taut::detail
