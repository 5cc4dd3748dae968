// The zero set as triangles, dual to the cells (Ju et al. 2002; manifold by Wenger 2013, sec. 3.5): each piece of
// surface in a cell has a vertex, brought onto the surface by Newton's method; each crossed edge of the grid gives a
// quad of the vertices around it, cut in two. Signs at corners decide about the topology; F is evaluated once a corner.
// A domain's edge is met by one more ring of cells, whose vertices are moved onto it.
#include "taut/cells/mesh_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "cells/cube_loops.hpp"
#include "cells/mesh_topology.hpp"
#include "cells/mesh_vertices.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::CellVertices;
using detail::cube_edge_corner;
using detail::CubeLoops;
using detail::kCubeTable;

/// The corners of all cells, each once, with the value of F there.
struct Corners {
  std::vector<std::array<int, 8>> of_cell;  ///< corner numbers
  std::vector<int> cell_above;              ///< of each corner: the cell whose corner 0 it is, or -1
  Points points;                            ///< 3 x n
  Vector values;                            ///< n
};

Corners collect_corners(const Surface& surface, const CellGrid& grid, const Context& context) {
  Corners corners;
  detail::check_mesh_size(grid);
  CellGrid numbers(grid.origin(), grid.size());  // corners are numbered like cells
  const Index num_cells = grid.num_cells();
  corners.of_cell.resize(static_cast<std::size_t>(num_cells));
  for (Index c = 0; c < num_cells; ++c) {
    if (c % 4096 == 0) context.check_cancelled();
    const auto cell = grid.cell(c);
    for (int b = 0; b < 8; ++b) {
      const std::array<std::int32_t, 3> corner = {cell[0] + (b & 1), cell[1] + (b >> 1 & 1), cell[2] + (b >> 2 & 1)};
      corners.of_cell[static_cast<std::size_t>(c)][static_cast<std::size_t>(b)] =
          static_cast<int>(numbers.insert(corner));
    }
  }
  const Index num_corners = numbers.num_cells();
  corners.cell_above.assign(static_cast<std::size_t>(num_corners), -1);
  for (Index c = 0; c < num_cells; ++c) {
    corners.cell_above[static_cast<std::size_t>(corners.of_cell[static_cast<std::size_t>(c)][0])] = static_cast<int>(c);
  }
  corners.points.resize(3, num_corners);
  for (Index i = 0; i < num_corners; ++i) {
    const auto corner = numbers.cell(i);
    for (Index a = 0; a < 3; ++a) {
      corners.points(a, i) = grid.origin()(a) + grid.size() * corner[static_cast<std::size_t>(a)];
    }
  }
  corners.values = detail::evaluate_values(surface.function(), corners.points, context);
  return corners;
}

/// The loops of every cell: which table entry it uses, and the number of its first vertex.
struct Pieces {
  std::vector<const CubeLoops*> loops;
  std::vector<int> first_vertex;
  int num_vertices = 0;
};

Pieces find_pieces(const Corners& corners) {
  const double level = detail::inside_level(corners.values);
  const std::size_t num_cells = corners.of_cell.size();
  std::vector<std::uint8_t> mask(num_cells, 0);
  std::vector<char> flipped(num_cells, 0);
  for (std::size_t c = 0; c < num_cells; ++c) {
    int m = 0;
    bool known = true;
    for (int b = 0; b < 8; ++b) {
      const double value = corners.values(corners.of_cell[c][static_cast<std::size_t>(b)]);
      known = known && !std::isnan(value);
      m |= (value < level ? 1 : 0) << b;
    }
    if (known) mask[c] = static_cast<std::uint8_t>(m);
  }
  for (std::size_t c = 0; c < num_cells; ++c) {
    const int face = kCubeTable.entry[mask[c]][0].joined_face;
    // Faces at coordinate 1 only: each pair of cells is met from its lower one.
    if (face == CubeLoops::kNoFace || (face & 1) == 0) continue;
    const int neighbour =
        corners.cell_above[static_cast<std::size_t>(corners.of_cell[c][std::size_t{1} << (face / 2)])];
    if (neighbour < 0) continue;
    const auto n = static_cast<std::size_t>(neighbour);
    // Joined on both sides: the one case that is not manifold. Flipping it in both parts them.
    if (kCubeTable.entry[mask[n]][0].joined_face != (face ^ 1)) continue;
    flipped[c] = flipped[n] = 1;
  }
  Pieces pieces;
  pieces.loops.resize(num_cells);
  pieces.first_vertex.resize(num_cells);
  for (std::size_t c = 0; c < num_cells; ++c) {
    pieces.loops[c] = &kCubeTable.entry[mask[c]][static_cast<std::size_t>(flipped[c])];
    pieces.first_vertex[c] = pieces.num_vertices;
    pieces.num_vertices += pieces.loops[c]->num_loops;
  }
  return pieces;
}

/// Where F is zero between two corners, as a part of the way, if it were linear.
double crossing(double value_a, double value_b) {
  const double t = value_a / (value_a - value_b);
  return std::isnan(t) ? 0.5 : std::clamp(t, 0.0, 1.0);
}

/// Each piece's vertex starts at the mean of its edges' crossings.
CellVertices start_vertices(const Corners& corners, const Pieces& pieces) {
  CellVertices vertices;
  const Index n = pieces.num_vertices;
  vertices.points = Points::Zero(3, n);
  vertices.inside.resize(3, n);
  vertices.outside.resize(3, n);
  vertices.cell.resize(static_cast<std::size_t>(n));
  std::vector<int> num_edges(static_cast<std::size_t>(n), 0);
  for (std::size_t c = 0; c < pieces.loops.size(); ++c) {
    const CubeLoops& loops = *pieces.loops[c];
    if (loops.num_loops == 0) continue;
    for (int e = 0; e < 12; ++e) {
      const int loop = loops.loop[static_cast<std::size_t>(e)];
      if (loop < 0) continue;
      const auto low = static_cast<std::size_t>(cube_edge_corner(e));
      int a = corners.of_cell[c][low];
      int b = corners.of_cell[c][low | std::size_t{1} << (e / 4)];
      if (corners.values(b) < corners.values(a)) std::swap(a, b);
      const int v = pieces.first_vertex[c] + loop;
      const double t = crossing(corners.values(a), corners.values(b));
      vertices.points.col(v) += (1 - t) * corners.points.col(a) + t * corners.points.col(b);
      vertices.inside.col(v) = corners.points.col(a);
      vertices.outside.col(v) = corners.points.col(b);
      vertices.cell[static_cast<std::size_t>(v)] = static_cast<Index>(c);
      ++num_edges[static_cast<std::size_t>(v)];
    }
  }
  for (Index v = 0; v < n; ++v) vertices.points.col(v) /= num_edges[static_cast<std::size_t>(v)];
  return vertices;
}

using Quad = std::array<int, 4>;

/// A quad for each crossed grid edge whose four cells are there, counter-clockwise seen from outside.
std::vector<Quad> connect(const Corners& corners, const Pieces& pieces, const std::vector<char>& valid) {
  std::vector<Quad> quads;
  quads.reserve(static_cast<std::size_t>(pieces.num_vertices));
  for (std::size_t c = 0; c < pieces.loops.size(); ++c) {
    if (pieces.loops[c]->num_loops == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      // The cell's edge at (1, 1) on the other axes i, j: the other three cells round it begin at corners of this one.
      const int edge = 4 * axis + 3;
      if (pieces.loops[c]->loop[static_cast<std::size_t>(edge)] < 0) continue;
      const int i = 1 << ((axis + 1) % 3);
      const int j = 1 << ((axis + 2) % 3);
      const std::array<int, 4> steps = {0, i, i | j, j};  // counter-clockwise round +axis, from below
      const std::array<int, 4> edges = {edge, edge - 1, edge - 3, edge - 2};  // the same edge, in those cells
      Quad quad{};
      bool complete = true;
      for (std::size_t s = 0; s < 4 && complete; ++s) {
        const int cell =
            s == 0
                ? static_cast<int>(c)
                : corners.cell_above[static_cast<std::size_t>(corners.of_cell[c][static_cast<std::size_t>(steps[s])])];
        const int loop =
            cell < 0 ? -1 : pieces.loops[static_cast<std::size_t>(cell)]->loop[static_cast<std::size_t>(edges[s])];
        complete = loop >= 0;
        if (!complete) break;
        quad[s] = pieces.first_vertex[static_cast<std::size_t>(cell)] + loop;
        complete = valid[static_cast<std::size_t>(quad[s])] != 0;
      }
      if (!complete) continue;
      const auto low = static_cast<std::size_t>(i | j);
      const double below = corners.values(corners.of_cell[c][low]);
      const double above = corners.values(corners.of_cell[c][low | std::size_t{1} << axis]);
      // Inside is above: counter-clockwise from the other side.
      if (below > above) std::swap(quad[1], quad[3]);
      quads.push_back(quad);
    }
  }
  return quads;
}

Eigen::Vector3d triangle_normal(const Points& x, int a, int b, int c) {
  return Eigen::Vector3d(x.col(b) - x.col(a)).cross(Eigen::Vector3d(x.col(c) - x.col(a)));
}

/// True when a quad is better cut from corner 0 to 2 than from 1 to 3: no triangle turned over, then the shorter cut.
bool cut_02(const Quad& q, const CellVertices& vertices) {
  const Points& x = vertices.points;
  const Eigen::Vector3d up =
      vertices.normals.col(q[0]) + vertices.normals.col(q[1]) + vertices.normals.col(q[2]) + vertices.normals.col(q[3]);
  const bool upright_02 =
      triangle_normal(x, q[0], q[1], q[2]).dot(up) > 0 && triangle_normal(x, q[0], q[2], q[3]).dot(up) > 0;
  const bool upright_13 =
      triangle_normal(x, q[1], q[2], q[3]).dot(up) > 0 && triangle_normal(x, q[1], q[3], q[0]).dot(up) > 0;
  // A triangle that is turned over would be seen as a dark fold.
  if (upright_02 != upright_13) return upright_02;
  return (x.col(q[0]) - x.col(q[2])).squaredNorm() <= (x.col(q[1]) - x.col(q[3])).squaredNorm();
}

Eigen::Matrix3Xi cut_quads(const std::vector<Quad>& quads, const CellVertices& vertices) {
  Eigen::Matrix3Xi faces(3, 2 * static_cast<Index>(quads.size()));
  Index f = 0;
  for (const Quad& q : quads) {
    const std::size_t s = cut_02(q, vertices) ? 0 : 1;
    faces.col(f++) << q[s], q[s + 1], q[(s + 2) % 4];
    faces.col(f++) << q[s], q[(s + 2) % 4], q[(s + 3) % 4];
  }
  return faces;
}

template <class Keep>
void keep_faces(Eigen::Matrix3Xi& faces, Keep keep) {
  Index kept = 0;
  for (Index f = 0; f < faces.cols(); ++f) {
    if (keep(faces.col(f))) faces.col(kept++) = faces.col(f);
  }
  faces.conservativeResize(3, kept);
}

/// A grid with one more ring of cells where the surface leaves the given ones, so that triangles reach over the
/// domain's edge.
struct WidenedGrid {
  CellGrid grid;
  std::vector<Index> origin;  ///< the given cell that each added one lies beside
};

WidenedGrid widen(const CellGrid& grid, const Pieces& pieces) {
  WidenedGrid wide{grid, {}};
  for (std::size_t c = 0; c < pieces.loops.size(); ++c) {
    for (int e = 0; e < 12 && pieces.loops[c]->num_loops > 0; ++e) {
      if (pieces.loops[c]->loop[static_cast<std::size_t>(e)] < 0) continue;
      const int i = (e / 4 + 1) % 3;
      const int j = (e / 4 + 2) % 3;
      const int step_i = (e & 1) != 0 ? 1 : -1;
      const int step_j = (e & 2) != 0 ? 1 : -1;
      for (int s = 1; s < 4; ++s) {
        std::array<std::int32_t, 3> cell{};
        const auto own = grid.cell(static_cast<Index>(c));
        std::copy(own.begin(), own.end(), cell.begin());
        if ((s & 1) != 0) cell[static_cast<std::size_t>(i)] += step_i;
        if ((s & 2) != 0) cell[static_cast<std::size_t>(j)] += step_j;
        const Index number = wide.grid.insert(cell);
        if (number == grid.num_cells() + static_cast<Index>(wide.origin.size()))
          wide.origin.push_back(static_cast<Index>(c));
      }
    }
  }
  return wide;
}

template <class Columns>
void pick_columns(Columns& columns, const std::vector<int>& which) {
  const Columns all = columns;
  columns.resize(all.rows(), static_cast<Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) columns.col(static_cast<Index>(i)) = all.col(which[i]);
}

}  // namespace

SurfaceMesh mesh_surface(const Surface& surface, const CellGrid& given_grid, const MeshOptions& options,
                         const Context& context) {
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument("a triangle mesh needs one equation in 3 dimensions; this surface has " +
                          std::to_string(surface.codim()) + " in " + std::to_string(surface.dim()));
  }
  if (given_grid.dim() != 3) {
    throw InvalidArgument("the cells have dimension " + std::to_string(given_grid.dim()) + ", the surface has 3");
  }
  const Index num_given = given_grid.num_cells();
  const bool cut = options.cut_at_domain && surface.domain() != nullptr;

  Corners corners = collect_corners(surface, given_grid, context);
  Pieces pieces = find_pieces(corners);
  WidenedGrid wide{given_grid, {}};
  if (cut) {
    wide = widen(given_grid, pieces);
    if (!wide.origin.empty()) {
      corners = collect_corners(surface, wide.grid, context);
      pieces = find_pieces(corners);
    }
  }
  CellVertices vertices = start_vertices(corners, pieces);
  detail::settle_vertices(surface, wide.grid, options.tolerance, vertices, context);

  SurfaceMesh mesh;
  mesh.faces = cut_quads(connect(corners, pieces, vertices.valid), vertices);
  if (cut) {
    const Eigen::Array<bool, Eigen::Dynamic, 1> inside = surface.inside_domain(vertices.points);
    const auto is_added = [&](int v) { return vertices.cell[static_cast<std::size_t>(v)] >= num_given; };
    keep_faces(mesh.faces, [&](const Eigen::Vector3i& face) {
      bool any_inside = false;
      // An added cell inside the domain was left out for another reason (the box): its triangles are not wanted.
      for (const int v : face) {
        if (inside(v) && is_added(v)) return false;
        any_inside = any_inside || inside(v);
      }
      return any_inside;
    });
    std::vector<Index> beyond;
    std::vector<char> seen(static_cast<std::size_t>(pieces.num_vertices), 0);
    for (const int v : mesh.faces.reshaped()) {
      if (inside(v) || seen[static_cast<std::size_t>(v)] != 0) continue;
      seen[static_cast<std::size_t>(v)] = 1;
      beyond.push_back(v);
    }
    detail::move_to_domain_edge(surface, beyond, 2 * wide.grid.size(), vertices.points, vertices.normals, context);
  }

  std::vector<int> source = detail::drop_unused_vertices(pieces.num_vertices, mesh.faces);
  for (const int v : detail::part_fans(static_cast<Index>(source.size()), mesh.faces)) {
    source.push_back(source[static_cast<std::size_t>(v)]);
  }
  mesh.vertices = std::move(vertices.points);
  mesh.normals = std::move(vertices.normals);
  pick_columns(mesh.vertices, source);
  pick_columns(mesh.normals, source);
  mesh.cell.reserve(source.size());
  for (const int v : source) {
    const Index c = vertices.cell[static_cast<std::size_t>(v)];
    mesh.cell.push_back(c < num_given ? c : wide.origin[static_cast<std::size_t>(c - num_given)]);
  }
  return mesh;
}

}  // namespace taut
