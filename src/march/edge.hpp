#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "march/tangent_coordinates.hpp"

namespace taut::detail {

/// A surface point as the march sees it: its coordinates (d) and an orthonormal basis of its normal space (d x k).
struct SurfacePoint {
  const double* x;
  const double* normals;
};

/// The step from a surface point y to a surface point x, seen as a short piece of one smooth sheet. N_y is the
/// projection onto the normal space at y.
template <int D>
struct Edge {
  SmallVector<D> chord;        ///< e = x - y
  SmallVector<D> normal_part;  ///< N_y e
  double length;               ///< geodesic distance of x and y, exact to fourth order in |e|
  double tangent_length;       ///< |e - N_y e|, at least a tiny positive number

  /// Component of a tangent vector at y along the edge.
  [[nodiscard]] double component(const SmallVector<D>& tangent) const { return tangent.dot(chord) / tangent_length; }
};

/// Normals that turn by more than this (cosine) over one step: the cells are too coarse for the surface there.
inline constexpr double kMinNormalCosine = 0.2;
/// On one smooth sheet N_y e and N_x e cancel up to the change of curvature along e; from one sheet to another, they
/// add up. Largest |N_y e + N_x e| taken for one sheet: this part of |N_y e| + |N_x e|, and in addition that part of
/// |e|.
inline constexpr double kMaxJump = 0.5;
inline constexpr double kMaxCurvatureChange = 0.15;

/// Fills `edge`; false when the normals at both ends say that x and y cannot be joined on one smooth sheet.
///
/// Length: a cubic over the chord c that leaves it with slope s0 and comes back with slope s1 has, to fourth order, the
/// length c (1 + b), b = (2 s0^2 - s0 s1 + 2 s1^2) / 30; the term in b^2 makes circular arcs right to sixth order.
template <int D, int K>
bool make_edge(const SurfacePoint& y, const SurfacePoint& x, Index d, Index k, Edge<D>& edge) {
  using Map = Eigen::Map<const SmallVector<D>>;
  edge.chord = Map(x.x, d) - Map(y.x, d);
  const double chord2 = edge.chord.squaredNorm();
  const double chord = std::sqrt(chord2);
  double part2_y;  // |N_y e|^2
  double part2_x;  // |N_x e|^2
  double product;  // N_y e . N_x e
  double parts;    // |N_y e| + |N_x e|
  // One normal has a sign, a basis of more has none.
  if (K == 1 || k == 1) {
    const Map ny(y.normals, d);
    const Map nx(x.normals, d);
    const double cosine = nx.dot(ny);
    if (!(cosine > kMinNormalCosine)) return false;
    const double part_y = ny.dot(edge.chord);
    const double part_x = nx.dot(edge.chord);
    edge.normal_part = part_y * ny;
    part2_y = part_y * part_y;
    part2_x = part_x * part_x;
    product = part_y * part_x * cosine;
    parts = std::abs(part_y) + std::abs(part_x);
  } else {
    SmallVector<D> normal_part_x = SmallVector<D>::Zero(d);
    edge.normal_part.setZero(d);
    double cosine2 = 0;  // sum of the squared cosines of the angles between the two normal spaces
    for (Index i = 0; i < k; ++i) {
      const Map ny(y.normals + i * d, d);
      const Map nx(x.normals + i * d, d);
      edge.normal_part += ny.dot(edge.chord) * ny;
      normal_part_x += nx.dot(edge.chord) * nx;
      for (Index j = 0; j < k; ++j) cosine2 += std::pow(Map(x.normals + j * d, d).dot(ny), 2);
    }
    // k - 1 of the angles may be 0; with all others 0, the largest one must have more than the same cosine as for k =
    // 1.
    if (!(cosine2 > static_cast<double>(k - 1) + kMinNormalCosine * kMinNormalCosine)) return false;
    part2_y = edge.normal_part.squaredNorm();
    part2_x = normal_part_x.squaredNorm();
    product = edge.normal_part.dot(normal_part_x);
    parts = std::sqrt(part2_y) + std::sqrt(part2_x);
  }
  const double allowed = kMaxJump * parts + kMaxCurvatureChange * chord;
  if (part2_y + part2_x + 2 * product > allowed * allowed) return false;
  constexpr double kTiny = 1e-290;
  // |N_y e| = c sin(angle of the chord with the tangent plane): s0^2 = |N_y e|^2 / c^2 and so on, to the order needed.
  const double bend = (2 * part2_y - product + 2 * part2_x) / (30 * chord2 + kTiny);
  edge.length = chord * (1 + bend * (1 + 2.7 * bend));
  edge.tangent_length = std::sqrt(std::max(chord2 - part2_y, kTiny));
  return true;
}

}  // namespace taut::detail
