#pragma once

#include <vector>

#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::detail {

/// A ray over the faces of a surface.
struct FacetRay {
  /// The whole: `error` and `direction_error` as grown on the faces after; conjugate points are looked for only where
  /// one face holds it all.
  ExponentialResult ray;
  /// An arc on a face. It ends in a crossing of an edge, but for the last one.
  struct Arc {
    int face = -1;
    Point3 x = Point3::Zero();  ///< where it begins
    double length = 0;
    double angle = 0;  ///< between the ray and the edge at its end, radians
  };
  std::vector<Arc> arcs;
};

/// From x, a point of the surface, along the tangential part of `direction` for arc length `length` (> 0). Over an edge
/// the part along it is kept and the rest turned into the other face. Ends early at a border (left_domain), in a
/// corner, along an edge, or where a face cannot be followed (not_converged); `reason` says so. Throws as
/// ExponentialMap::trace.
[[nodiscard]] FacetRay trace_over_faces(FacetedSurface& surface, const Point3& x, const Point3& direction,
                                        double length, const ExponentialOptions& options, const Context& context);

}  // namespace taut::detail
