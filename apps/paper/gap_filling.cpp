#include "gap_filling.hpp"

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut::paper {
namespace {

/// Equation (5), min |F(p)| subject to (p - middle) . AB = 0: the nearest zero of F along the axes of that plane, by a
/// walk to the first change of sign and bisection. Of the many ways to solve (5) it is one that needs no gradient,
/// which may vanish half-way between two walls. `middle` itself where there is no zero within reach.
Vector nearest_in_plane(const Surface& surface, const Vector& middle, const Vector& ab) {
  constexpr int kSteps = 400;          // of a twentieth of the gap
  constexpr int kBisections = 60;      // to rounding
  constexpr double kOnSurface = 1e-6;  // of the gap: else F only jumps there
  const double gap = ab.norm();
  const auto value = [&surface](const Vector& x) { return surface.value(x)(0, 0); };
  const double at_middle = value(middle);
  if (std::abs(at_middle) <= 1e-12 * gap) return middle;
  const Eigen::MatrixXd axes = Eigen::HouseholderQR<Eigen::MatrixXd>(ab).householderQ();  // the first along AB
  Vector nearest = middle;
  double least = std::numeric_limits<double>::infinity();
  for (Index axis = 1; axis < ab.size(); ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vector step = 0.05 * gap * side * axes.col(axis);
      for (int k = 1; k <= kSteps && (k - 1) * step.norm() < least; ++k) {
        if (value(middle + k * step) * at_middle > 0) continue;
        double near = k - 1;
        double far = k;
        for (int i = 0; i < kBisections; ++i) {
          const double half = 0.5 * (near + far);
          (value(middle + half * step) * at_middle > 0 ? near : far) = half;
        }
        const Vector found = middle + far * step;
        if (std::abs(value(found)) <= kOnSurface * gap && far * step.norm() < least) {
          least = far * step.norm();
          nearest = found;
        }
        break;
      }
    }
  }
  return nearest;
}

Vector new_node(const Surface& surface, const Vector& a, const Vector& b, NodeProjection projection) {
  if (projection == NodeProjection::in_plane) return nearest_in_plane(surface, 0.5 * (a + b), b - a);
  // A thousandth off the middle: exactly half-way between two walls the gradient vanishes.
  const Vector start = 0.501 * a + 0.499 * b;
  try {
    return project_to_surface(surface, start).point;
  } catch (const SingularPoint&) {
    return start;
  }
}

}  // namespace

GapFilling fill_gap(const Surface& surface, const VectorIn& a, const VectorIn& b, Index num_nodes,
                    NodeProjection projection) {
  std::vector<Vector> nodes = {a, b};
  GapFilling filling;
  const auto interval = [&nodes](std::size_t i) { return (nodes[i + 1] - nodes[i]).norm(); };
  for (Index count = 0; count <= num_nodes; ++count) {
    std::size_t widest = 0;
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) widest = interval(i) > interval(widest) ? i : widest;
    filling.longest.push_back(interval(widest));
    if (count == num_nodes) break;
    nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(widest) + 1,
                 new_node(surface, nodes[widest], nodes[widest + 1], projection));
  }
  filling.nodes.resize(surface.dim(), static_cast<Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) filling.nodes.col(static_cast<Index>(i)) = nodes[i];
  return filling;
}

}  // namespace taut::paper
