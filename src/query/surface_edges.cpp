// The edges, corners and faces of a surface that is not smooth, told for people and files: lines of points (3 x n) with
// their angles, the formulas' names of the faces, and how many patches each face has. Found by strata/edge_network.
// Empty for other than surfaces in space, and for formulas without kinks.
#include "taut/query/surface_summary.hpp"

#include <cstddef>
#include <optional>

#include "query/edges_of.hpp"
#include "strata/facet_complex.hpp"
#include "taut/cells/find_cells.hpp"

namespace taut {
namespace {

SurfaceEdge told(detail::FacetedSurface& surface, const detail::EdgeLine& line) {
  SurfaceEdge edge;
  const detail::SharpEdge of = surface.edge(line.edge);
  // Nothing on the other side: the domain cuts the surface there. A seam is an edge in name only: its faces join
  // smoothly.
  edge.kind = of.b < 0                           ? SurfaceEdge::Kind::border
              : line.angle <= detail::kSeamAngle ? SurfaceEdge::Kind::seam
                                                 : SurfaceEdge::Kind::sharp;
  edge.faces.push_back(surface.face(of.a).text);
  if (of.b >= 0) edge.faces.push_back(surface.face(of.b).text);
  edge.length = line.length;
  edge.angle = line.angle;
  edge.closed = line.closed;
  edge.cut = line.cut;
  edge.points.resize(3, static_cast<Index>(line.points.size()));
  for (std::size_t i = 0; i < line.points.size(); ++i) edge.points.col(static_cast<Index>(i)) = line.points[i];
  return edge;
}

}  // namespace

const char* to_string(SurfaceEdge::Kind kind) {
  switch (kind) {
    case SurfaceEdge::Kind::sharp: return "sharp";
    case SurfaceEdge::Kind::seam: return "seam";
    case SurfaceEdge::Kind::border: return "border";
  }
  return "unknown";
}

namespace detail {

SurfaceEdges edges_of(FacetComplex& complex) {
  SurfaceEdges result;
  for (const EdgeLine& line : complex.network.lines) result.edges.push_back(told(*complex.surface, line));
  result.corners.resize(3, static_cast<Index>(complex.network.corners.size()));
  for (std::size_t i = 0; i < complex.network.corners.size(); ++i) {
    result.corners.col(static_cast<Index>(i)) = complex.network.corners[i].x;
  }
  for (std::size_t i = 0; i < complex.network.patches.size(); ++i) {
    const int patches = complex.network.patches[i];
    if (patches > 0) result.faces.push_back({complex.surface->face(static_cast<int>(i)).text, patches});
  }
  return result;
}

}  // namespace detail

SurfaceEdges surface_edges(const Surface& surface, const Box& box, const Context& context) {
  if (surface.dim() != 3 || surface.codim() != 1) return {};
  const Box searched = box.dim() == 3 ? box : find_box(surface, Points(3, 0), context);
  std::optional<detail::FacetComplex> complex = detail::FacetComplex::of(surface, searched, context);
  return complex ? detail::edges_of(*complex) : SurfaceEdges{};
}

}  // namespace taut
