#pragma once

#include "taut/core/mesh.hpp"

namespace taut::paper {

/// Cubes of edge `size` about centres (3 x n) as a mesh, each with its value as the scalar `name`: for colouring cells.
/// Faces between two cubes are left out.
[[nodiscard]] TriangleMesh cell_faces(const PointsIn& centres, double size, const VectorIn& values,
                                      const std::string& name);

}  // namespace taut::paper
