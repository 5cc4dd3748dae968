#include "cell_faces.hpp"

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace taut::paper {

TriangleMesh cell_faces(const PointsIn& centres, double size, const VectorIn& values, const std::string& name) {
  // Places on the lattice, counted from the first cell.
  using Place = std::array<long, 3>;
  std::map<Place, Index> cells;
  const auto place_of = [&](Index i) {
    const Eigen::Vector3d steps = (centres.col(i) - centres.col(0)) / size;
    return Place{std::lround(steps.x()), std::lround(steps.y()), std::lround(steps.z())};
  };
  for (Index i = 0; i < centres.cols(); ++i) cells[place_of(i)] = i;

  std::vector<Eigen::Vector3d> vertices;
  std::vector<double> scalars;
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Vector3i> faces;
  for (Index i = 0; i < centres.cols(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        Place next = place_of(i);
        next[static_cast<std::size_t>(axis)] += side;
        if (cells.contains(next)) continue;
        const Eigen::Vector3d out = side * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3);
        const Eigen::Vector3d v = out.cross(u);
        const int first = static_cast<int>(vertices.size());
        for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
          vertices.emplace_back(centres.col(i) + 0.5 * size * (out + a * u + b * v));
          normals.push_back(out);
          scalars.push_back(values(i));
        }
        faces.emplace_back(first, first + 1, first + 2);
        faces.emplace_back(first, first + 2, first + 3);
      }
    }
  }
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Index>(vertices.size()));
  mesh.normals.resize(3, mesh.vertices.cols());
  VertexScalar scalar{name, Vector(mesh.vertices.cols())};
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    mesh.vertices.col(static_cast<Index>(i)) = vertices[i];
    mesh.normals.col(static_cast<Index>(i)) = normals[i];
    scalar.values(static_cast<Index>(i)) = scalars[i];
  }
  mesh.faces.resize(3, static_cast<Index>(faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i) mesh.faces.col(static_cast<Index>(i)) = faces[i];
  mesh.scalars.push_back(std::move(scalar));
  return mesh;
}

}  // namespace taut::paper
