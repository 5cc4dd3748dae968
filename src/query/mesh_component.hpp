#pragma once

#include "taut/cells/mesh_surface.hpp"

namespace taut::detail {

/// Drops all of a mesh but one connected piece, with the edges drawn on it: the `which`-th largest by area, from 1.
/// Vertices at one place hang together. Throws InvalidArgument where there are fewer pieces.
void keep_component(SurfaceMesh& mesh, int which);

}  // namespace taut::detail
