#pragma once

#include <vector>

#include "surface/normals/neighbour_graph.hpp"
#include "surface/normals/sheet_split.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Two unoriented normals compared across an edge: n_b is mirrored in the plane half-way, as on a circle through both
/// points, then compared with n_a.
struct EdgeComparison {
  double agreement = 0;  ///< cosine: < 0 where the two signs disagree
  double along = 0;      ///< how much the edge runs along the normals (0 .. 2): such edges lead off the surface
};
[[nodiscard]] EdgeComparison compare_normals(const Points& points, const Points& normals, NeighbourGraph::Edge edge);

/// Makes the signs of `normals` agree along a minimum spanning forest of the graph (Hoppe et al. 1992), edges with the
/// best comparison first. Returns the piece of each point, named by one of its points.
[[nodiscard]] std::vector<Index> orient_along_forest(const Points& points, const NeighbourGraph& graph,
                                                     Points& normals);

/// The same where some samples lie on two sheets side by side: those of one sheet are made to agree first, then the
/// sheets face away from each other.
[[nodiscard]] std::vector<Index> orient_sheets(const Points& points, const NeighbourGraph& graph,
                                               const SheetSplit& split, Points& normals);

/// Turns each piece so that its flux sum (p - centre) . n dA is positive: d times the volume it encloses where closed.
void turn_outwards(const Points& points, const Vector& spacing, const std::vector<Index>& piece, Points& normals);

/// Turns each piece most of whose samples have a sheet opposite so that most of those sheets lie inside.
void turn_from_opposite(const Points& points, const SheetSplit& split, const std::vector<Index>& piece,
                        Points& normals);

}  // namespace taut::detail
