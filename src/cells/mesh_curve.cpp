// Curves in the plane as segments, the dual of the cells: a vertex for each piece of curve in a cell, brought onto the
// curve by Newton's method, and a segment across each crossed edge between two cells. Where inside corners lie
// diagonally opposite, the pieces are kept apart.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "cells/mesh_vertices.hpp"
#include "taut/cells/mesh_surface.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

// The square, by bits as the cube: corner b has coordinate 1 on axis a when bit a of b is set. Edge 2 a + i runs along
// axis a at coordinate i on the other axis.

/// The chain (piece of curve) of each edge in a square, -1 where it is not crossed. Inside corners diagonally opposite
/// are kept apart.
std::array<int, 4> trace_chains(const std::array<bool, 4>& inside) {
  std::array<int, 4> chain{-1, -1, -1, -1};
  const bool split = inside[0] == inside[3] && inside[1] == inside[2] && inside[0] != inside[1];
  for (int e = 0; e < 4; ++e) {
    const int a = e / 2;
    const int low = (e & 1) << (1 - a);
    const int high = low | 1 << a;
    if (inside[static_cast<std::size_t>(low)] == inside[static_cast<std::size_t>(high)]) continue;
    const int inner = inside[static_cast<std::size_t>(low)] ? low : high;
    chain[static_cast<std::size_t>(e)] = split && inner >= 2 ? 1 : 0;
  }
  return chain;
}

}  // namespace

CurveMesh mesh_curve(const Surface& surface, const CellGrid& grid, const MeshOptions& options, const Context& context) {
  if (surface.dim() != 2 || surface.codim() != 1 || grid.dim() != 2) {
    throw InvalidArgument("a curve mesh needs one equation and cells in 2 dimensions; this surface has " +
                          std::to_string(surface.codim()) + " in " + std::to_string(surface.dim()) +
                          ", the cells have " + std::to_string(grid.dim()));
  }
  detail::check_mesh_size(grid);
  const auto num_cells = static_cast<std::size_t>(grid.num_cells());
  CellGrid numbers(grid.origin(), grid.size());
  std::vector<std::array<int, 4>> corners(num_cells);
  for (std::size_t c = 0; c < num_cells; ++c) {
    const auto cell = grid.cell(static_cast<Index>(c));
    for (int b = 0; b < 4; ++b) {
      const std::array<std::int32_t, 2> corner = {cell[0] + (b & 1), cell[1] + (b >> 1)};
      corners[c][static_cast<std::size_t>(b)] = static_cast<int>(numbers.insert(corner));
    }
  }
  Points positions(2, numbers.num_cells());
  for (Index i = 0; i < numbers.num_cells(); ++i) {
    for (Index a = 0; a < 2; ++a) {
      positions(a, i) = grid.origin()(a) + grid.size() * numbers.cell(i)[static_cast<std::size_t>(a)];
    }
  }
  const Vector values = detail::evaluate_values(surface.function(), positions, context);
  const double level = detail::inside_level(values);

  std::vector<int> cell_above(static_cast<std::size_t>(numbers.num_cells()), -1);
  std::vector<std::array<int, 4>> vertex_of_edge(num_cells);
  detail::CellVertices vertices;
  std::vector<Eigen::Vector2d> starts, inside_ends, outside_ends;
  for (std::size_t c = 0; c < num_cells; ++c) {
    cell_above[static_cast<std::size_t>(corners[c][0])] = static_cast<int>(c);
    std::array<bool, 4> inside{};
    bool known = true;
    for (std::size_t b = 0; b < 4; ++b) {
      inside[b] = values(corners[c][b]) < level;
      known = known && !std::isnan(values(corners[c][b]));
    }
    vertex_of_edge[c] = known ? trace_chains(inside) : std::array<int, 4>{-1, -1, -1, -1};
    const auto first = static_cast<int>(starts.size());
    for (std::size_t e = 0; e < 4; ++e) {
      int& vertex = vertex_of_edge[c][e];
      if (vertex < 0) continue;
      vertex += first;
      const std::size_t low = (e & 1) << (1 - e / 2);
      int a = corners[c][low];
      int b = corners[c][low | std::size_t{1} << (e / 2)];
      // a is the inside end.
      if (values(b) < values(a)) std::swap(a, b);
      const double t = values(a) / (values(a) - values(b));
      const double s = std::isnan(t) ? 0.5 : std::clamp(t, 0.0, 1.0);
      const Eigen::Vector2d x = (1 - s) * positions.col(a) + s * positions.col(b);
      if (vertex == static_cast<int>(starts.size())) {
        starts.push_back(x);
        inside_ends.emplace_back(positions.col(a));
        outside_ends.emplace_back(positions.col(b));
        vertices.cell.push_back(static_cast<Index>(c));
      } else {
        starts[static_cast<std::size_t>(vertex)] = 0.5 * (starts[static_cast<std::size_t>(vertex)] + x);
      }
    }
  }
  const auto n = static_cast<Index>(starts.size());
  vertices.points.resize(2, n);
  vertices.inside.resize(2, n);
  vertices.outside.resize(2, n);
  for (Index v = 0; v < n; ++v) {
    vertices.points.col(v) = starts[static_cast<std::size_t>(v)];
    vertices.inside.col(v) = inside_ends[static_cast<std::size_t>(v)];
    vertices.outside.col(v) = outside_ends[static_cast<std::size_t>(v)];
  }
  detail::settle_vertices(surface, grid, options.tolerance, vertices, context);
  const bool cut = options.cut_at_domain && surface.domain() != nullptr;
  const Eigen::Array<bool, Eigen::Dynamic, 1> in_domain =
      cut ? surface.inside_domain(vertices.points) : Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(n, true);

  // A segment for each crossed edge whose two cells are there, its inside to the left.
  std::vector<Eigen::Vector2i> segments;
  std::vector<int> number(static_cast<std::size_t>(n), -1);
  std::vector<Index> beyond;
  for (std::size_t c = 0; c < num_cells; ++c) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int here = vertex_of_edge[c][2 * axis + 1];
      if (here < 0) continue;
      const std::size_t low = std::size_t{1} << (1 - axis);
      const int neighbour = cell_above[static_cast<std::size_t>(corners[c][low])];
      if (neighbour < 0) continue;
      const int there = vertex_of_edge[static_cast<std::size_t>(neighbour)][2 * axis];
      if (there < 0 || vertices.valid[static_cast<std::size_t>(here)] == 0 ||
          vertices.valid[static_cast<std::size_t>(there)] == 0)
        continue;
      // Segments that cross the domain's edge stay; their outer ends are moved onto it below.
      if (!in_domain(here) && !in_domain(there)) continue;
      // Walking along axis 1 (up) the left side is at lower x; walking along axis 0 (right) it is at higher y.
      const bool low_is_inside = values(corners[c][low]) < values(corners[c][low | std::size_t{1} << axis]);
      const bool forward = (axis == 0) == low_is_inside;
      segments.emplace_back(forward ? here : there, forward ? there : here);
      for (const int v : {here, there}) {
        if (number[static_cast<std::size_t>(v)] < 0 && !in_domain(v)) beyond.push_back(v);
        number[static_cast<std::size_t>(v)] = 0;
      }
    }
  }
  if (cut) detail::move_to_domain_edge(surface, beyond, 2 * grid.size(), vertices.points, vertices.normals, context);

  CurveMesh mesh;
  int kept = 0;
  for (Index v = 0; v < n; ++v) {
    if (number[static_cast<std::size_t>(v)] < 0) continue;
    number[static_cast<std::size_t>(v)] = kept;
    vertices.points.col(kept) = vertices.points.col(v);
    vertices.normals.col(kept) = vertices.normals.col(v);
    mesh.cell.push_back(vertices.cell[static_cast<std::size_t>(v)]);
    ++kept;
  }
  mesh.vertices = vertices.points.leftCols(kept);
  mesh.normals = vertices.normals.leftCols(kept);
  mesh.segments.resize(2, static_cast<Index>(segments.size()));
  for (std::size_t s = 0; s < segments.size(); ++s) {
    mesh.segments.col(static_cast<Index>(s)) << number[static_cast<std::size_t>(segments[s](0))],
        number[static_cast<std::size_t>(segments[s](1))];
  }
  return mesh;
}

}  // namespace taut
