#pragma once

#include <vector>

#include "taut/core/mesh.hpp"
#include "taut/query/distance.hpp"

namespace taut {

/// The lines on a triangle mesh at which a value given at its vertices (n, linear between them) takes one of `levels`,
/// each in order along its line with lower values to the left seen from outside. One that meets itself repeats its
/// first point at its end. Triangles with a corner that has no finite value are left out. A scalar "level" tells each
/// point's. Throws InvalidArgument when there is not one value a vertex.
[[nodiscard]] Polylines trace_isolines(const TriangleMesh& mesh, const Vector& values,
                                       const std::vector<double>& levels);

/// The same for distances on the surface itself: every point is moved along the geodesic that arrives there until its
/// distance is the level's, to the solver's tolerance. Where that fails (beside a cut locus, where the line has a
/// corner, or where distances are not known) it stays on the mesh's line. `mesh` and `values` come from the solver's
/// surface; `num_moved`, when not null, receives how many points have been brought to their level.
[[nodiscard]] Polylines distance_isolines(DistanceSolver& solver, const TriangleMesh& mesh, const Vector& values,
                                          const std::vector<double>& levels, Index* num_moved = nullptr);

/// `count` levels at equal steps between 0 and the largest finite value, both left out.
[[nodiscard]] std::vector<double> even_levels(const Vector& values, int count);

}  // namespace taut
