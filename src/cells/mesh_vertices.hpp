#pragma once

#include <vector>

#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Meshes number vertices by int, up to eight corners and four pieces a cell: throws OutOfMemory where that could
/// overflow.
void check_mesh_size(const CellGrid& grid);

/// F at every point (d x n): n values.
Vector evaluate_values(const ImplicitFunction& function, const Points& points, const Context& context);

/// The level below which a corner counts as inside: a hair under zero, so that corners where F is zero but for rounding
/// all fall on the same side.
double inside_level(const Vector& corner_values);

/// Vertices on their way to the surface, one a piece of surface in a cell.
struct CellVertices {
  Points points;            ///< d x n: the start, then the vertex
  Points normals;           ///< d x n: written
  std::vector<Index> cell;  ///< n: in `grid`
  Points inside, outside;   ///< d x n: ends of one crossed edge of the cell, F < 0 and F >= 0 there
  std::vector<char> valid;  ///< n: written; 0 where F has no zero on that edge either (a pole, a NaN)
};

/// Brings each vertex onto the surface by Newton's method, x -= F grad F / |grad F|^2 [paper, sec. 4]; where that does
/// not converge or leaves the cell by more than a quarter of its size, by bisection of the crossed edge.
void settle_vertices(const Surface& surface, const CellGrid& grid, double tolerance, CellVertices& vertices,
                     const Context& context);

/// Moves the given vertices onto the edge of the domain, {F = 0, min domain = 0}, by least-norm Newton steps. One that
/// would move farther than `reach` stays where it is.
void move_to_domain_edge(const Surface& surface, const std::vector<Index>& which, double reach, Points& points,
                         Points& normals, const Context& context);

}  // namespace taut::detail
