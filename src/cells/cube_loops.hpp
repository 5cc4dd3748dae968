#pragma once

#include <array>
#include <cstdint>

namespace taut::detail {

// The cube of marching cubes, by bits: corner b has coordinate 1 on axis a when bit a of b is set. Edge 4 a + i + 2 j
// runs along axis a at coordinates (i, j) on the axes (a + 1) % 3, (a + 2) % 3. Face 2 a + s lies at coordinate s on
// axis a. A sign mask has bit b set where corner b is inside (F < 0).

/// The edge between two corners that differ in one bit.
constexpr int cube_edge(int corner_a, int corner_b) {
  const int bit = corner_a ^ corner_b;
  const int axis = bit == 1 ? 0 : bit == 2 ? 1 : 2;
  const int i = corner_a >> ((axis + 1) % 3) & 1;
  const int j = corner_a >> ((axis + 2) % 3) & 1;
  return 4 * axis + i + 2 * j;
}

/// The lower corner of an edge; the upper one has bit 1 << (edge / 4) set as well.
constexpr int cube_edge_corner(int edge) {
  const int axis = edge / 4;
  return (edge & 1) << ((axis + 1) % 3) | (edge >> 1 & 1) << ((axis + 2) % 3);
}

/// Corners of a face in cyclic order.
constexpr std::array<int, 4> cube_face(int face) {
  const int axis = face / 2;
  const int base = (face & 1) << axis;
  const int b = 1 << ((axis + 1) % 3);
  const int c = 1 << ((axis + 2) % 3);
  return {base, base | b, base | b | c, base | c};
}

/// How the surface passes through a cube of one sign mask: its crossed edges fall into closed loops, one a piece of
/// surface.
struct CubeLoops {
  static constexpr std::int8_t kNoFace = -1;

  std::uint8_t num_loops = 0;
  std::array<std::int8_t, 12> loop{};  ///< of each edge, -1 where it is not crossed
  /// The ambiguous face whose two segments belong to one loop, or kNoFace.
  std::int8_t joined_face = kNoFace;
};

constexpr bool is_ambiguous(int mask, const std::array<int, 4>& face) {
  const int m =
      (mask >> face[0] & 1) | (mask >> face[1] & 1) << 1 | (mask >> face[2] & 1) << 2 | (mask >> face[3] & 1) << 3;
  return m == 5 || m == 10;
}

/// Traces the loops. On an ambiguous face (inside corners diagonally opposite) a segment goes round each inside corner,
/// except on face `flipped`, where one goes round each outside corner.
constexpr CubeLoops trace_loops(int mask, int flipped) {
  CubeLoops result;
  std::array<int, 12> parent{};
  for (int e = 0; e < 12; ++e) parent[e] = e;
  const auto root = [&](int e) {
    while (parent[e] != e) e = parent[e];
    return e;
  };
  for (int f = 0; f < 6; ++f) {
    const std::array<int, 4> face = cube_face(f);
    if (is_ambiguous(mask, face)) {
      for (int i = 0; i < 4; ++i) {
        const bool inside = (mask >> face[i] & 1) != 0;
        // Corners that a segment goes round: the inside ones by the rule, the outside ones where flipped.
        if (inside == (f == flipped)) continue;
        parent[root(cube_edge(face[i], face[(i + 1) % 4]))] = root(cube_edge(face[i], face[(i + 3) % 4]));
      }
      continue;
    }
    int first = -1;
    for (int i = 0; i < 4; ++i) {
      const int a = face[i];
      const int b = face[(i + 1) % 4];
      if ((mask >> a & 1) == (mask >> b & 1)) continue;
      if (first < 0) {
        first = cube_edge(a, b);
      } else {
        parent[root(first)] = root(cube_edge(a, b));
      }
    }
  }
  for (int e = 0; e < 12; ++e) result.loop[e] = -1;
  std::array<int, 12> number{};
  for (int e = 0; e < 12; ++e) number[e] = -1;
  for (int e = 0; e < 12; ++e) {
    const int a = cube_edge_corner(e);
    if ((mask >> a & 1) == (mask >> (a | 1 << (e / 4)) & 1)) continue;
    int& n = number[root(e)];
    if (n < 0) n = result.num_loops++;
    result.loop[e] = static_cast<std::int8_t>(n);
  }
  for (int f = 0; f < 6; ++f) {
    const std::array<int, 4> face = cube_face(f);
    if (!is_ambiguous(mask, face)) continue;
    const int first = result.loop[cube_edge(face[0], face[1])];
    bool joined = true;
    for (int i = 1; i < 4; ++i) joined = joined && result.loop[cube_edge(face[i], face[(i + 1) % 4])] == first;
    // All four crossed edges of the face are on one loop.
    if (joined) result.joined_face = static_cast<std::int8_t>(f);
  }
  return result;
}

/// Loops of every mask: [0] by the rule, [1] with the joined face flipped, which parts its two segments.
struct CubeTable {
  std::array<std::array<CubeLoops, 2>, 256> entry{};
};

constexpr CubeTable make_cube_table() {
  CubeTable table;
  for (int mask = 0; mask < 256; ++mask) {
    table.entry[mask][0] = trace_loops(mask, CubeLoops::kNoFace);
    table.entry[mask][1] = trace_loops(mask, table.entry[mask][0].joined_face);
  }
  return table;
}

inline constexpr CubeTable kCubeTable = make_cube_table();

/// What makes the dual mesh manifold (Wenger, Isosurfaces, 2013, sec. 3.5): two cubes would share an edge of the dual
/// twice only when an ambiguous face is joined on both sides. Such a cube has no other ambiguous face, so flipping that
/// face in both parts them and touches nobody else.
constexpr bool joined_faces_can_be_parted() {
  for (int mask = 0; mask < 256; ++mask) {
    if (kCubeTable.entry[mask][0].joined_face == CubeLoops::kNoFace) continue;
    int ambiguous = 0;
    for (int f = 0; f < 6; ++f) ambiguous += is_ambiguous(mask, cube_face(f)) ? 1 : 0;
    if (ambiguous != 1) return false;
    if (kCubeTable.entry[mask][1].joined_face != CubeLoops::kNoFace) return false;
  }
  return true;
}
static_assert(joined_faces_can_be_parted());

}  // namespace taut::detail
