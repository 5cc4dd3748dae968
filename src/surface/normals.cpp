#include "taut/surface/normals.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::KdTree;
using detail::MergedPoints;
using detail::Neighbour;

/// Each column to length 1; columns without a direction to zero.
void normalise(Points& normals) {
  for (Index i = 0; i < normals.cols(); ++i) {
    const double length = normals.col(i).stableNorm();
    if (std::isfinite(length) && length > 0) {
      normals.col(i) /= length;
    } else {
      normals.col(i).setZero();
    }
  }
}

// --- given normals --------------------------------------------------------------------------------------------------

Points from_given(const PointCloud& cloud, const MergedPoints& merged) {
  Points unit = cloud.normals;
  normalise(unit);
  Points normals = Points::Zero(merged.points.rows(), merged.points.cols());
  for (Index i = 0; i < unit.cols(); ++i) normals.col(merged.merged_to[static_cast<std::size_t>(i)]) += unit.col(i);
  for (Index i = 0; i < normals.cols(); ++i) {
    // What is left of opposite normals at one point is rounding.
    if (normals.col(i).norm() < 1e-6) normals.col(i).setZero();
  }
  normalise(normals);
  return normals;
}

// --- normals of faces -----------------------------------------------------------------------------------------------

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
  std::map<std::pair<Index, Index>, int> uses;
  for (const auto& face : mesh.faces) {
    for (std::size_t corner = 0; corner < 3; ++corner) ++uses[{face[corner], face[(corner + 1) % 3]}];
  }
  Winding result;
  for (const auto& [edge, count] : uses) {
    if (count > 1) result.consistent = false;
    if (!uses.contains({edge.second, edge.first})) result.closed = false;
  }
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
  normalise(normals);
  return normals;
}

// --- estimated normals ----------------------------------------------------------------------------------------------

/// Direction of least spread of the neighbours, its sign arbitrary.
Vector least_spread(const Points& points, const KdTree& tree, Index i, Index neighbours) {
  std::vector<Neighbour> found;
  for (;; neighbours *= 2) {
    tree.nearest(points.col(i).data(), neighbours, found);
    Vector mean = Vector::Zero(points.rows());
    for (const Neighbour& q : found) mean += points.col(q.index);
    mean /= static_cast<double>(found.size());
    Eigen::MatrixXd moment = Eigen::MatrixXd::Zero(points.rows(), points.rows());
    for (const Neighbour& q : found) {
      const Vector u = points.col(q.index) - mean;
      moment.noalias() += u * u.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spread(moment);
    const auto& values = spread.eigenvalues();
    const bool determined = values(1) > 1e-12 * values(values.size() - 1);
    if (determined || static_cast<Index>(found.size()) == points.cols()) return spread.eigenvectors().col(0);
  }
}

struct Edge {
  double weight;
  Index a;
  Index b;
  bool flips;  // the two ends' present signs disagree
};

/// Compares two unoriented normals across an edge: n_b is mirrored in the plane half-way, as on a circle through both
/// points, then compared with n_a. Edges along a normal lead off the surface and come last.
Edge compare(const Points& points, const Points& normals, Index a, Index b) {
  const Vector e = (points.col(b) - points.col(a)).normalized();
  const double along_a = e.dot(normals.col(a));
  const double along_b = e.dot(normals.col(b));
  const double agreement = normals.col(a).dot(normals.col(b)) - 2 * along_a * along_b;
  return {1 - std::abs(agreement) + std::abs(along_a) + std::abs(along_b), a, b, agreement < 0};
}

/// Makes the signs agree along a minimum spanning forest; returns the piece of each point.
std::vector<Index> orient_along_tree(const Points& points, const KdTree& tree, Index neighbours, Points& normals) {
  const Index n = points.cols();
  std::vector<Edge> edges;
  std::vector<Neighbour> found;
  for (Index i = 0; i < n; ++i) {
    tree.nearest(points.col(i).data(), neighbours, found);
    for (const Neighbour& q : found) {
      if (q.index != i) edges.push_back(compare(points, normals, std::min(i, q.index), std::max(i, q.index)));
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    if (x.weight != y.weight) return x.weight < y.weight;
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  detail::DisjointSets joined(static_cast<std::size_t>(n));
  std::vector<std::vector<std::pair<Index, bool>>> forest(static_cast<std::size_t>(n));
  for (const Edge& edge : edges) {
    if (!joined.unite(static_cast<std::uint32_t>(edge.a), static_cast<std::uint32_t>(edge.b))) continue;
    forest[static_cast<std::size_t>(edge.a)].emplace_back(edge.b, edge.flips);
    forest[static_cast<std::size_t>(edge.b)].emplace_back(edge.a, edge.flips);
  }
  std::vector<Index> piece(static_cast<std::size_t>(n), -1);
  std::vector<std::pair<Index, bool>> stack;
  for (Index root = 0; root < n; ++root) {
    if (piece[static_cast<std::size_t>(root)] >= 0) continue;
    stack.emplace_back(root, false);
    while (!stack.empty()) {
      const auto [i, flipped] = stack.back();
      stack.pop_back();
      piece[static_cast<std::size_t>(i)] = root;
      if (flipped) normals.col(i) *= -1;
      for (const auto& [next, flips] : forest[static_cast<std::size_t>(i)]) {
        if (piece[static_cast<std::size_t>(next)] < 0) stack.emplace_back(next, flipped != flips);
      }
    }
  }
  return piece;
}

/// Turns each piece so that its flux sum (p - centre) . n dA is positive: d times the volume it encloses where closed.
void turn_outwards(const Points& points, const KdTree& tree, const std::vector<Index>& piece, Points& normals) {
  const Vector spacing = detail::local_spacing(points, tree);
  std::map<Index, std::vector<Index>> members;
  for (Index i = 0; i < points.cols(); ++i) members[piece[static_cast<std::size_t>(i)]].push_back(i);
  for (const auto& [root, points_of_piece] : members) {
    const Vector centre = points(Eigen::all, points_of_piece).rowwise().mean();
    double flux = 0;
    for (const Index i : points_of_piece) {
      const double area = std::pow(spacing(i), static_cast<double>(points.rows() - 1));
      flux += area * (points.col(i) - centre).dot(normals.col(i));
    }
    if (flux >= 0) continue;
    for (const Index i : points_of_piece) normals.col(i) *= -1;
  }
}

Points by_spread(const Points& points, const KdTree& tree, Index neighbours, const Context& context) {
  Points normals(points.rows(), points.cols());
  detail::parallel_for(context, 0, points.cols(), 256, [&](Index first, Index last) {
    for (Index i = first; i < last; ++i) normals.col(i) = least_spread(points, tree, i, neighbours);
  });
  const std::vector<Index> piece = orient_along_tree(points, tree, neighbours, normals);
  turn_outwards(points, tree, piece, normals);
  return normals;
}

/// Gives the zero columns the mean of their nearest known neighbours, weighted by inverse distance.
void repair(const Points& points, Points& normals, const Context& context) {
  std::vector<Index> known;
  std::vector<Index> unknown;
  for (Index i = 0; i < normals.cols(); ++i) (normals.col(i).isZero(0) ? unknown : known).push_back(i);
  if (unknown.empty()) return;
  const Points known_points = points(Eigen::all, known);
  const KdTree tree(known_points);
  std::vector<Neighbour> found;
  for (const Index i : unknown) {
    tree.nearest(points.col(i).data(), 6, found);
    Vector mean = Vector::Zero(points.rows());
    for (const Neighbour& q : found) {
      mean += normals.col(known[static_cast<std::size_t>(q.index)]) / std::sqrt(q.squared_distance);
    }
    if (!(mean.norm() > 0)) mean = normals.col(known[static_cast<std::size_t>(found.front().index)]);
    normals.col(i) = mean.normalized();
  }
  context.tell(std::to_string(unknown.size()) + " points without a usable normal took that of their neighbours");
}

/// Normals and faces that belong to the points.
void require_consistent(const PointCloud& cloud) {
  if (cloud.normals.cols() > 0 && (cloud.normals.rows() != cloud.dim() || cloud.normals.cols() != cloud.size())) {
    throw InvalidArgument("the normals are " + std::to_string(cloud.normals.rows()) + " x " +
                          std::to_string(cloud.normals.cols()) + ", the points " + std::to_string(cloud.dim()) + " x " +
                          std::to_string(cloud.size()));
  }
  for (Index f = 0; f < cloud.faces.cols(); ++f) {
    for (const int vertex : cloud.faces.col(f)) {
      if (vertex >= 0 && vertex < cloud.size()) continue;
      throw InvalidArgument("face " + std::to_string(f) + " names point " + std::to_string(vertex) + " of " +
                            std::to_string(cloud.size()));
    }
  }
}

}  // namespace

Points estimate_normals(const PointCloud& cloud, Index neighbours, const Context& context) {
  const Index d = cloud.dim();
  detail::require_finite(cloud.points, "point");
  require_consistent(cloud);
  const MergedPoints merged = detail::merge_duplicates(cloud.points);
  const Index rank = detail::affine_rank(merged.points);
  if (d < 2 || rank < d - 1) {
    throw InvalidArgument(std::to_string(merged.points.cols()) + " different points in " + std::to_string(d) +
                          " dimensions span only " + std::to_string(rank) +
                          (rank == 1 ? " direction (they lie on a line)" : " directions") + ": a surface needs " +
                          std::to_string(std::max<Index>(d - 1, 1)));
  }
  const KdTree tree(merged.points);
  const Index enough = std::max<Index>(neighbours, 2 * d);
  Points normals;
  if (cloud.has_normals()) {
    normals = from_given(cloud, merged);
  } else if (d == 3 && cloud.faces.cols() > 0) {
    const Mesh mesh = merged_mesh(cloud, merged);
    const Winding wound = winding(mesh);
    if (wound.consistent) {
      normals = from_faces(mesh);
      if (wound.closed && signed_volume(mesh) < 0) {
        normals *= -1;
        context.tell("the mesh is wound inside out: its normals are turned");
      }
    } else {
      context.tell("the faces are not wound consistently: normals are estimated from the points");
    }
  }
  if (normals.cols() == 0 || normals.isZero(0)) {
    normals = by_spread(merged.points, tree, enough, context);
  } else {
    repair(merged.points, normals, context);
  }
  return normals(Eigen::all, merged.merged_to);
}

}  // namespace taut
