#pragma once

#include <cstddef>
#include <vector>

#include "strata/facet_graph.hpp"
#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// A corner that reaches into faces, where they have more than 180 degrees, next to a way.
struct ReflexCorner {
  Point3 x;
  std::vector<int> faces;
  std::size_t step = 0;  ///< of the way, nearest to it
};

/// One way between two points over a graph: what a path is corrected from.
struct FacetWay {
  double length = 0;
  std::vector<Point3> points;  ///< from p to q
  /// One a step between points: faces that both points lie on.
  std::vector<std::vector<int>> faces;
  std::vector<bool> corner;  ///< one a point
  std::vector<int> edge;     ///< one a point: the edge it lies on, or -1
  std::vector<ReflexCorner> reflex;
};

/// Ways from p to q (on the surface) no longer than `slack` times the shortest: one for each way round, and one for
/// each row of faces. Shortest first; empty where there is none.
[[nodiscard]] std::vector<FacetWay> ways_between(FacetedSurface& surface, const FacetGraph& graph, const Point3& p,
                                                 const Point3& q, double slack);

}  // namespace taut::detail
