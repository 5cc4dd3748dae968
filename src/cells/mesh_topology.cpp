// Vertices at which several fans of triangles meet are repeated, one for each fan, so that every vertex has a disc or
// half a disc around it. Fans are found through shared edges; a vertex has few triangles, so that all pairs are
// compared.
#include "cells/mesh_topology.hpp"

#include <algorithm>

namespace taut::detail {
namespace {

/// The corner of a fan: triangle `face` has the vertex at row `corner`; `next` and `previous` are its other vertices.
struct Wedge {
  Index face;
  int corner;
  int next;
  int previous;
  int fan;
};

/// Numbers the fans of the wedges round one vertex from 0; returns how many there are.
int number_fans(std::vector<Wedge>& wedges) {
  int num_fans = 0;
  for (Wedge& wedge : wedges) wedge.fan = -1;
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < wedges.size(); ++start) {
    if (wedges[start].fan >= 0) continue;
    wedges[start].fan = num_fans;
    open.assign(1, start);
    while (!open.empty()) {
      const std::size_t current = open.back();
      open.pop_back();
      for (std::size_t other = 0; other < wedges.size(); ++other) {
        if (wedges[other].fan >= 0) continue;
        // Neighbours in a fan share an edge from the vertex, run through in opposite directions.
        if (wedges[other].previous != wedges[current].next && wedges[other].next != wedges[current].previous) continue;
        wedges[other].fan = num_fans;
        open.push_back(other);
      }
    }
    ++num_fans;
  }
  return num_fans;
}

}  // namespace

std::vector<int> part_fans(Index num_vertices, Eigen::Matrix3Xi& faces) {
  std::vector<Index> begin(static_cast<std::size_t>(num_vertices) + 1, 0);
  for (const int v : faces.reshaped()) ++begin[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Index> corners(static_cast<std::size_t>(faces.size()));  // 3 face + row, by vertex
  std::vector<Index> end(begin.begin(), begin.end() - 1);
  for (Index c = 0; c < faces.size(); ++c)
    corners[static_cast<std::size_t>(end[static_cast<std::size_t>(faces(c % 3, c / 3))]++)] = c;

  std::vector<int> repeats;
  std::vector<Wedge> wedges;
  for (Index v = 0; v < num_vertices; ++v) {
    wedges.clear();
    for (Index i = begin[static_cast<std::size_t>(v)]; i < begin[static_cast<std::size_t>(v) + 1]; ++i) {
      const Index face = corners[static_cast<std::size_t>(i)] / 3;
      const int corner = static_cast<int>(corners[static_cast<std::size_t>(i)] % 3);
      wedges.push_back({face, corner, faces((corner + 1) % 3, face), faces((corner + 2) % 3, face), -1});
    }
    const int num_fans = number_fans(wedges);
    for (const Wedge& wedge : wedges) {
      if (wedge.fan > 0)
        faces(wedge.corner, wedge.face) =
            static_cast<int>(num_vertices + static_cast<Index>(repeats.size())) + wedge.fan - 1;
    }
    for (int fan = 1; fan < num_fans; ++fan) repeats.push_back(static_cast<int>(v));
  }
  return repeats;
}

std::vector<int> drop_unused_vertices(Index num_vertices, Eigen::Matrix3Xi& faces) {
  std::vector<int> renumbered(static_cast<std::size_t>(num_vertices), -1);
  for (const int v : faces.reshaped()) renumbered[static_cast<std::size_t>(v)] = 0;
  std::vector<int> kept;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] < 0) continue;
    renumbered[v] = static_cast<int>(kept.size());
    kept.push_back(static_cast<int>(v));
  }
  for (int& v : faces.reshaped()) v = renumbered[static_cast<std::size_t>(v)];
  return kept;
}

}  // namespace taut::detail
