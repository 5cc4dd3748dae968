// Pieces of a mesh by its triangles' vertices. Faces that meet in an edge may have vertices of their own there, at the
// same place to the last bit.
#include "query/mesh_component.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/disjoint_sets.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// Of each vertex the piece it belongs to, as the number of one of its vertices.
std::vector<std::uint32_t> pieces_of(const SurfaceMesh& mesh) {
  const auto n = static_cast<std::size_t>(mesh.vertices.cols());
  DisjointSets sets(n);
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    for (const Index i : {1, 2}) {
      sets.unite(static_cast<std::uint32_t>(mesh.faces(0, f)), static_cast<std::uint32_t>(mesh.faces(i, f)));
    }
  }
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  const auto place = [&](std::uint32_t i) {
    const auto x = mesh.vertices.col(i);
    return std::array{x(0), x(1), x(2)};
  };
  std::ranges::sort(order, {}, place);
  for (std::size_t i = 1; i < n; ++i) {
    if (place(order[i]) == place(order[i - 1])) sets.unite(order[i], order[i - 1]);
  }
  std::vector<std::uint32_t> piece(n);
  for (std::uint32_t i = 0; i < n; ++i) piece[i] = sets.find(i);
  return piece;
}

double area_of(const SurfaceMesh& mesh, Index face) {
  const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, face));
  const Eigen::Vector3d b = mesh.vertices.col(mesh.faces(1, face));
  const Eigen::Vector3d c = mesh.vertices.col(mesh.faces(2, face));
  return (b - a).cross(c - a).norm() / 2;
}

/// Does a line lie on the piece: the vertex nearest to its first point does.
bool is_on(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& piece, std::uint32_t kept, const Points& line) {
  Index nearest = 0;
  (mesh.vertices.colwise() - line.col(0)).colwise().squaredNorm().minCoeff(&nearest);
  return piece[static_cast<std::size_t>(nearest)] == kept;
}

}  // namespace

void keep_component(SurfaceMesh& mesh, int which) {
  const std::vector<std::uint32_t> piece = pieces_of(mesh);
  const auto piece_of = [&](Index face) { return piece[static_cast<std::size_t>(mesh.faces(0, face))]; };
  std::map<std::uint32_t, double> area;
  for (Index f = 0; f < mesh.faces.cols(); ++f) area[piece_of(f)] += area_of(mesh, f);
  std::vector<std::pair<double, std::uint32_t>> by_area;
  for (const auto& [label, size] : area) by_area.emplace_back(-size, label);
  std::ranges::sort(by_area);
  if (which < 1 || static_cast<std::size_t>(which) > by_area.size()) {
    throw InvalidArgument(
        fmt::format("component {}: the mesh has {}, numbered from 1, the largest", which, by_area.size()));
  }
  const std::uint32_t kept = by_area[static_cast<std::size_t>(which - 1)].second;

  std::erase_if(mesh.edges.lines, [&](const Points& line) { return !is_on(mesh, piece, kept, line); });
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    if (piece_of(f) == kept) faces.push_back(f);
  }
  std::vector<Index> vertices;
  std::vector<int> number(piece.size(), -1);
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (piece[i] != kept) continue;
    number[i] = static_cast<int>(vertices.size());
    vertices.push_back(static_cast<Index>(i));
  }
  mesh.faces = mesh.faces(Eigen::all, faces).eval();
  for (int& vertex : mesh.faces.reshaped()) vertex = number[static_cast<std::size_t>(vertex)];
  if (mesh.has_normals()) mesh.normals = mesh.normals(Eigen::all, vertices).eval();
  mesh.vertices = mesh.vertices(Eigen::all, vertices).eval();
  for (VertexScalar& scalar : mesh.scalars) scalar.values = scalar.values(vertices).eval();
  if (mesh.cell.size() == piece.size()) {
    for (std::size_t i = 0; i < vertices.size(); ++i) mesh.cell[i] = mesh.cell[static_cast<std::size_t>(vertices[i])];
    mesh.cell.resize(vertices.size());
  }
}

}  // namespace taut::detail
