#pragma once

#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// How far the surface stands off the faces of the mesh through whose vertices it was fitted: the largest |F| / |grad
/// F| at the middles of faces, a spread of a few thousand of them; model units. 0 where there are no faces.
[[nodiscard]] double distance_off_faces(const Surface& surface);

/// Tells the user so where it is more than a hundredth of a path of that length: what was found is then no path over
/// the mesh.
void tell_of_ignored_faces(const Surface& surface, double length, const Context& context);

}  // namespace taut::app
