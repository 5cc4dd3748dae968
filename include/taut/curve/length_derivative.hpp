#pragma once

#include "taut/core/types.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut {

/// How the length of a geodesic of F(x, c) = 0 changes with the parameters c (m), its ends moving with the surface
/// along its normals (as projection moves them): dL/dc = int x'' . J^+ dF/dc ds, by the multipliers of the constraint
/// alone. `function` is F of d + m variables, x first. Exact as the geodesic is (1e-12 and less on curves of Newton's
/// method at 1e-13). Throws InvalidArgument where the dimensions do not fit or the curve is empty.
[[nodiscard]] Vector length_derivative(const ImplicitFunction& function, const SpectralCurve& geodesic,
                                       const VectorIn& parameters);

}  // namespace taut
