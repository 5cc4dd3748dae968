#pragma once

#include <memory>
#include <optional>

#include "strata/facet_chain.hpp"
#include "strata/facet_ways.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A polyline laid over the faces of a surface with edges.
struct OverFaces {
  std::unique_ptr<FacetedSurface> surface;
  FacetWay way;
  int only_face = -1;  ///< it lies on; -1: it crosses edges

  /// Is a curve (3 x m) on that face where the face is part of the surface.
  [[nodiscard]] bool stays(const Points& curve);
};

/// Null for surfaces without edges. Throws InvalidArgument where the polyline cannot be laid over the faces.
[[nodiscard]] std::optional<OverFaces> lay_over_faces(const Surface& surface, const PointsIn& polyline, bool closed);

/// What becomes of it when it is pulled taut, its ends held: into `result`, with an obstacle where it is not known.
void pull_taut(OverFaces& over, PathResult& result, const Context& context);

/// The same of a closed polyline that crosses edges. `neutral` counts the ways to move it that keep its length.
void pull_loop_taut(OverFaces& over, PathResult& result, int& neutral, const Context& context);

}  // namespace taut::detail
