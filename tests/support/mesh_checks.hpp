#pragma once

// What every triangle mesh can be asked: is it a manifold, how many pieces, holes and boundary loops has it, how large
// is it.

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "taut/core/mesh.hpp"

namespace taut::test {

inline Eigen::Vector3d face_normal(const TriangleMesh& mesh, Index f) {
  const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, f));
  const Eigen::Vector3d b = mesh.vertices.col(mesh.faces(1, f));
  const Eigen::Vector3d c = mesh.vertices.col(mesh.faces(2, f));
  return (b - a).cross(c - a);
}

inline double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.cols(); ++f) sum += 0.5 * face_normal(mesh, f).norm();
  return sum;
}

/// Enclosed volume; positive when the triangles of a closed mesh point outwards.
inline double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.cols(); ++f)
    sum += face_normal(mesh, f).dot(mesh.vertices.col(mesh.faces(0, f))) / 6;
  return sum;
}

struct MeshReport {
  /// Every directed edge once, the two triangles of an edge in opposite directions, one fan round every vertex, no
  /// vertex unused.
  bool manifold = true;
  Index euler_characteristic = 0;
  Index num_components = 0;
  Index num_boundary_loops = 0;
  double boundary_length = 0;
};

inline MeshReport check_mesh(const TriangleMesh& mesh) {
  MeshReport report;
  const Index n = mesh.vertices.cols();
  std::set<std::pair<int, int>> directed;
  std::vector<int> parent(static_cast<std::size_t>(n));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v)
      v = parent[static_cast<std::size_t>(v)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(v)])];
    return v;
  };
  std::vector<std::map<int, int>> link(static_cast<std::size_t>(n));  // round v: next -> previous of each triangle
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.faces(i, f);
      const int b = mesh.faces((i + 1) % 3, f);
      const int c = mesh.faces((i + 2) % 3, f);
      if (a < 0 || a >= n || a == b) return {.manifold = false};
      if (!directed.emplace(a, b).second) report.manifold = false;
      link[static_cast<std::size_t>(a)][b] = c;
      parent[static_cast<std::size_t>(root(a))] = root(b);
    }
  }
  Index num_edges = 0;
  std::map<int, int> boundary;
  for (const auto& [a, b] : directed) {
    const bool twin = directed.contains({b, a});
    if (!twin || a < b) ++num_edges;
    if (twin) continue;
    if (!boundary.emplace(a, b).second) report.manifold = false;
    report.boundary_length += (mesh.vertices.col(a) - mesh.vertices.col(b)).norm();
  }
  for (const std::map<int, int>& around : link) {
    // One walk must use all triangles: from the open start if there is one, else from anywhere.
    if (around.empty()) {
      report.manifold = false;
      continue;
    }
    std::set<int> ends;
    for (const auto& [next, previous] : around) ends.insert(previous);
    int start = around.begin()->first;
    for (const auto& [next, previous] : around) {
      if (!ends.contains(next)) start = next;
    }
    std::size_t steps = 0;
    int v = start;
    do {
      const auto it = around.find(v);
      if (it == around.end()) break;
      v = it->second;
      ++steps;
    } while (v != start && steps <= around.size());
    if (steps != around.size()) report.manifold = false;
  }
  while (!boundary.empty()) {
    ++report.num_boundary_loops;
    auto it = boundary.begin();
    while (it != boundary.end()) {
      const int next = it->second;
      boundary.erase(it);
      it = boundary.find(next);
    }
  }
  for (int v = 0; v < n; ++v) report.num_components += root(v) == v ? 1 : 0;
  report.euler_characteristic = n - num_edges + mesh.faces.cols();
  return report;
}

}  // namespace taut::test
