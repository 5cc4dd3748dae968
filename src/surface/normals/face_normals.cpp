#include "surface/normals/face_normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace taut::detail {
namespace {

struct Mesh {
  const Points& points;
  std::vector<std::array<Index, 3>> faces;  // of merged points, without degenerate ones
};

Mesh merged_mesh(const PointCloud& cloud, const MergedPoints& merged) {
  Mesh mesh{merged.points, {}};
  for (Index f = 0; f < cloud.faces.cols(); ++f) {
    std::array<Index, 3> face{};
    for (int corner = 0; corner < 3; ++corner) {
      face[static_cast<std::size_t>(corner)] = merged.merged_to[static_cast<std::size_t>(cloud.faces(corner, f))];
    }
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) mesh.faces.push_back(face);
  }
  return mesh;
}

struct Winding {
  bool consistent = true;  // no directed edge is used twice
  bool closed = true;      // every directed edge has its opposite
};

Winding winding(const Mesh& mesh) {
  using Edge = std::pair<Index, Index>;
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (const auto& face : mesh.faces) {
    for (std::size_t corner = 0; corner < 3; ++corner) edges.emplace_back(face[corner], face[(corner + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  Winding result;
  result.consistent = std::adjacent_find(edges.begin(), edges.end()) == edges.end();
  result.closed = std::all_of(edges.begin(), edges.end(), [&](const Edge& edge) {
    return std::binary_search(edges.begin(), edges.end(), Edge(edge.second, edge.first));
  });
  return result;
}

double signed_volume(const Mesh& mesh) {
  const Eigen::Vector3d centre = mesh.points.rowwise().mean();
  double volume = 0;
  for (const auto& face : mesh.faces) {
    const Eigen::Vector3d a = mesh.points.col(face[0]) - centre;
    const Eigen::Vector3d b = mesh.points.col(face[1]) - centre;
    const Eigen::Vector3d c = mesh.points.col(face[2]) - centre;
    volume += a.cross(b).dot(c) / 6;
  }
  return volume;
}

/// The mean of the adjacent face normals weighted by the corner's angle, which does not depend on how a flat part is
/// cut into triangles.
Points from_faces(const Mesh& mesh) {
  Points normals = Points::Zero(3, mesh.points.cols());
  for (const auto& face : mesh.faces) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d at = mesh.points.col(face[corner]);
      const Eigen::Vector3d u = mesh.points.col(face[(corner + 1) % 3]) - at;
      const Eigen::Vector3d v = mesh.points.col(face[(corner + 2) % 3]) - at;
      const Eigen::Vector3d across = u.cross(v);
      const double area = across.norm();
      if (area > 0) normals.col(face[corner]) += std::atan2(area, u.dot(v)) / area * across;
    }
  }
  normalise_columns(normals);
  return normals;
}

}  // namespace

void normalise_columns(Points& normals) {
  for (Index i = 0; i < normals.cols(); ++i) {
    const double length = normals.col(i).stableNorm();
    if (std::isfinite(length) && length > 0) {
      normals.col(i) /= length;
    } else {
      normals.col(i).setZero();
    }
  }
}

std::optional<Points> face_normals(const PointCloud& cloud, const MergedPoints& merged, const Context& context) {
  const Mesh mesh = merged_mesh(cloud, merged);
  const Winding wound = winding(mesh);
  if (!wound.consistent) {
    context.tell("the faces are not wound consistently: normals are estimated from the points");
    return std::nullopt;
  }
  Points normals = from_faces(mesh);
  if (wound.closed && signed_volume(mesh) < 0) {
    normals *= -1;
    context.tell("the mesh is wound inside out: its normals are turned");
  }
  return normals;
}

}  // namespace taut::detail
