#pragma once

#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// How neighbours of a geodesic from 1 to 2 on a 2-surface spread (Karney 2013, sec. 3): solutions of j'' + K j = 0, K
/// the Gaussian curvature along it.
struct GeodesicScales {
  Status status = Status::ok;  ///< rank_deficient where J loses rank on the way or the ray cannot be followed, else ok
  double m12 = 0;              ///< reduced length, model units: j at 2 with (j, j') = (0, 1) at 1
  double M12 = 1;              ///< geodesic scale: j at 2 with (1, 0) at 1
  double M21 = 1;              ///< the same from 2 to 1; also j' at 2 with (0, 1) at 1
  double error = 0;            ///< estimated, of m12 / length, M12 and M21
};

/// Of the geodesic that leaves `from` (d, on the surface) along the unit tangent `direction` (d) for `length` >= 0. Any
/// d with d - k = 2; throws InvalidArgument otherwise. Gauss collocation of order 16 for the ray and the fields, steps
/// halved until nothing changes. Checked: M12 M21 - m12 M12' = 1; the references to 1e-10 of the largest of the three.
[[nodiscard]] GeodesicScales geodesic_scales(const Surface& surface, const VectorIn& from, const VectorIn& direction,
                                             double length);

}  // namespace taut
