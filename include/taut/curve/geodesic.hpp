#pragma once

#include <optional>
#include <string_view>

#include "taut/core/status.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut {

/// How far a curve is from being a geodesic of the surface.
struct CurveResidual {
  double surface = 0;             ///< max |F| / |grad F| along the curve, between nodes too, model units
  double geodesic_curvature = 0;  ///< sup |k_g| along the curve, 1 / model units
};

/// A corrected curve.
struct Geodesic {
  Status status = Status::not_converged;
  double length = 0;                   ///< model units
  double length_error = 0;             ///< honest estimate of |length - true length of this geodesic|, model units
  bool locally_shortest = false;       ///< by certificate: no conjugate point inside
  std::optional<double> conjugate_at;  ///< arc length from the start of the first conjugate point, when one is inside
  /// Directions in which the length falls (Morse index): 0 = locally shortest. Newton's method with d - k > 65 counts
  /// those in which it falls equally once. Empty where it was not found out: no geodesic, or the flow's on a saddle.
  std::optional<int> index;
  CurveResidual residual;
  int num_iterations = 0;
  /// d x m in order, first and last exactly the end points given, every one on the surface: what to draw or write.
  Points points;
  /// d each: the unit tangents at the ends, in the direction of travel, of a spectral curve; empty where there is none.
  /// The distance changes by minus the first when the start moves, and by the second when the end does.
  Vector start_direction;
  Vector end_direction;
  /// Why the status is not ok, in a few words for people; empty when it is.
  std::string_view reason;
};

/// How the length of a geodesic of F(x, c) = 0 changes with the parameters c (m), its ends moving with the surface
/// along its normals (as projection moves them): dL/dc = int x'' . J^+ dF/dc ds, by the multipliers of the constraint
/// alone. `function` is F of d + m variables, x first. Exact as the geodesic is (1e-12 and less on curves of Newton's
/// method at 1e-13). Throws InvalidArgument where the dimensions do not fit or the curve is empty.
[[nodiscard]] Vector length_derivative(const ImplicitFunction& function, const SpectralCurve& geodesic,
                                       const VectorIn& parameters);

}  // namespace taut
