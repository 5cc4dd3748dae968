#pragma once

#include "surface/local_fit/support_radii.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// Places of the surface F = 0 over those faces of a mesh that the balls around their corners do not cover, with the
/// normals of F and how far each speaks for surface. `support`: of each sample.
[[nodiscard]] SupportPlaces places_between(const FacedSamples& mesh, const Vector& support,
                                           const ImplicitFunction& function, const Context& context);

}  // namespace taut::detail
