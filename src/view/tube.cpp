#include "view/tube.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace taut::detail {
namespace {

constexpr int kSides = 12;
constexpr int kCapRings = 4;
constexpr int kBallSides = 28;
constexpr int kBallRings = 14;

/// Rings of `sides` vertices joined in order.
void join_rings(Tube& tube, Index num_rings, int sides) {
  tube.faces.resize(3, 2 * (num_rings - 1) * sides);
  Index f = 0;
  for (Index ring = 0; ring + 1 < num_rings; ++ring) {
    for (int s = 0; s < sides; ++s) {
      const int a = static_cast<int>(ring) * sides + s;
      const int b = static_cast<int>(ring) * sides + (s + 1) % sides;
      tube.faces.col(f++) << a, b, b + sides;
      tube.faces.col(f++) << a, b + sides, a + sides;
    }
  }
}

}  // namespace

Tube make_tube(const Eigen::Matrix3Xf& polyline, float radius) {
  Eigen::Matrix3Xf x(3, polyline.cols());
  Index n = 0;
  for (const auto& p : polyline.colwise()) {
    if (n == 0 || (p - x.col(n - 1)).norm() > 1e-3F * radius) x.col(n++) = p;
  }
  if (n < 2) return make_ball(polyline.col(0), radius);
  x.conservativeResize(3, n);

  const Index num_rings = n + 2 * kCapRings;
  Tube tube;
  tube.positions.resize(3, num_rings * kSides);
  tube.normals.resize(3, num_rings * kSides);
  Eigen::Vector3f tangent = (x.col(1) - x.col(0)).normalized();
  Eigen::Vector3f side = tangent.unitOrthogonal();
  Index ring = 0;
  // `along` and `across`: the direction of the normal in the (tangent, side) plane; a cap is a quarter turn of it.
  const auto add_ring = [&](const Eigen::Vector3f& centre, float along, float across) {
    const Eigen::Vector3f other = tangent.cross(side);
    for (int s = 0; s < kSides; ++s) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(s) / kSides;
      const Eigen::Vector3f out = std::cos(angle) * side + std::sin(angle) * other;
      const Eigen::Vector3f normal = along * tangent + across * out;
      tube.positions.col(ring * kSides + s) = centre + radius * normal;
      tube.normals.col(ring * kSides + s) = normal;
    }
    ++ring;
  };
  for (int k = 0; k < kCapRings; ++k) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(k) / kCapRings;
    add_ring(x.col(0), -std::cos(angle), std::sin(angle));
  }
  for (Index i = 0; i < n; ++i) {
    const Eigen::Vector3f in = (x.col(i) - x.col(std::max<Index>(i - 1, 0))).normalized();
    const Eigen::Vector3f out = (x.col(std::min(i + 1, n - 1)) - x.col(i)).normalized();
    const Eigen::Vector3f turned = i == 0 ? out : i == n - 1 ? in : Eigen::Vector3f(in + out);
    if (turned.norm() > 1e-3F) tangent = turned.normalized();
    side -= tangent * tangent.dot(side);
    if (side.norm() < 1e-3F) side = tangent.unitOrthogonal();
    side.normalize();
    add_ring(x.col(i), 0, 1);
  }
  for (int k = kCapRings - 1; k >= 0; --k) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(k) / kCapRings;
    add_ring(x.col(n - 1), std::cos(angle), std::sin(angle));
  }
  join_rings(tube, num_rings, kSides);
  return tube;
}

Tube make_ball(const Eigen::Vector3f& centre, float radius) {
  Tube ball;
  ball.positions.resize(3, (kBallRings + 1) * kBallSides);
  ball.normals.resize(3, (kBallRings + 1) * kBallSides);
  for (int ring = 0; ring <= kBallRings; ++ring) {
    const float polar = std::numbers::pi_v<float> * static_cast<float>(ring) / kBallRings;
    for (int s = 0; s < kBallSides; ++s) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(s) / kBallSides;
      const Eigen::Vector3f normal(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                                   -std::cos(polar));
      ball.positions.col(ring * kBallSides + s) = centre + radius * normal;
      ball.normals.col(ring * kBallSides + s) = normal;
    }
  }
  join_rings(ball, kBallRings + 1, kBallSides);
  return ball;
}

}  // namespace taut::detail
