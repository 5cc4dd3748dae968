#include "geodesic_delaunay.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace taut::paper {

TriangleMesh geodesic_delaunay(const FarthestPoints& chosen, const SurfaceMesh& mesh) {
  const auto region = [&](int vertex) {
    return chosen.nearest[static_cast<std::size_t>(mesh.cell[static_cast<std::size_t>(vertex)])];
  };
  // A small triangle whose corners lie in three regions holds the place where these meet.
  std::vector<Eigen::Vector3i> faces;
  std::set<std::array<Index, 3>> seen;
  for (const auto& face : mesh.faces.colwise()) {
    const std::array<Index, 3> corners = {region(face(0)), region(face(1)), region(face(2))};
    std::array<Index, 3> sorted = corners;
    std::ranges::sort(sorted);
    if (sorted[0] < 0 || sorted[0] == sorted[1] || sorted[1] == sorted[2]) continue;
    if (!seen.insert(sorted).second) continue;
    faces.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2]));
  }
  TriangleMesh dual;
  dual.vertices = chosen.points;
  dual.faces.resize(3, static_cast<Index>(faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i) dual.faces.col(static_cast<Index>(i)) = faces[i];
  return dual;
}

Vector smallest_angles(const TriangleMesh& mesh) {
  Vector angles(mesh.faces.cols());
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    double least = std::numbers::pi;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d corner = mesh.vertices.col(mesh.faces(i, f));
      const Eigen::Vector3d u = mesh.vertices.col(mesh.faces((i + 1) % 3, f)) - corner;
      const Eigen::Vector3d v = mesh.vertices.col(mesh.faces((i + 2) % 3, f)) - corner;
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
    angles(f) = least * 180 / std::numbers::pi;
  }
  return angles;
}

}  // namespace taut::paper
