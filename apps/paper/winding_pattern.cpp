// A geodesic on a surface of revolution keeps r sin(angle to the meridian) (Clairaut), swings between two parallels,
// and goes the same angle round the axis on every circuit. It closes where that angle is a fraction of a full turn.

#include "winding_pattern.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "curves.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::paper {
namespace {

/// Angle round the z axis along a polyline, every turn counted.
double angle_round_axis(const Points& line) {
  double angle = 0;
  for (Index i = 0; i + 1 < line.cols(); ++i) {
    const auto a = line.col(i), b = line.col(i + 1);
    angle += std::atan2(a(0) * b(1) - a(1) * b(0), a(0) * b(0) + a(1) * b(1));
  }
  return angle;
}

class Winder {
 public:
  Winder(const Surface& vessel, double radius, const Context& context)
      : map_(vessel, {.conjugate = false}), start_(radius, 0, 0), context_(context) {}

  ExponentialResult trace(double angle, double length) {
    ExponentialResult ray = map_.trace(start_, direction(angle), length, context_);
    if (ray.status != Status::ok)
      throw InvalidArgument("the fibre does not get round the vessel: " + std::string(ray.reason));
    return ray;
  }

  static Vector direction(double angle) { return Eigen::Vector3d(0, std::sin(angle), std::cos(angle)); }

  /// Length of one circuit: from the equator over both domes to the equator again, upwards.
  double circuit(double angle) {
    double length = circuit_ > 0 ? circuit_ : first_guess(angle);
    constexpr int kSteps = 30;  // Newton's method on the height of the end: a handful suffice
    for (int step = 0; step < kSteps; ++step) {
      const ExponentialResult ray = trace(angle, length);
      const double change = -ray.point(2) / ray.direction(2);
      length += change;
      if (std::abs(change) < 1e-13 * length) break;
    }
    return circuit_ = length;
  }

  double advance(double angle) { return angle_round_axis(trace(angle, circuit(angle)).points); }

 private:
  /// Follows the ray until it has come down through the equator and up again.
  double first_guess(double angle) {
    const double size = start_.norm();
    constexpr int kLongest = 64;  // radii; vessels are not longer
    const Points line = trace(angle, kLongest * size).points;
    double length = 0;
    int crossings = 0;
    for (Index i = 1; i + 1 < line.cols(); ++i) {
      length += (line.col(i) - line.col(i - 1)).norm();
      crossings += line(2, i) * line(2, i + 1) <= 0 ? 1 : 0;
      if (crossings == 2) return length;
    }
    throw InvalidArgument("the fibre does not come back to the equator");
  }

  ExponentialMap map_;
  Eigen::Vector3d start_;
  const Context& context_;
  double circuit_ = 0;
};

}  // namespace

WindingPattern close_winding(const Surface& vessel, double radius, double angle, int num_circuits,
                             const Context& context) {
  Winder winder(vessel, radius, context);
  WindingPattern pattern{.num_circuits = num_circuits};
  double advance = winder.advance(angle);
  const double turn = 2 * std::numbers::pi;
  pattern.num_turns = static_cast<int>(std::lround(num_circuits * advance / turn));
  // With a common factor the fibre would close early and leave gaps.
  while (std::gcd(pattern.num_turns, num_circuits) != 1) ++pattern.num_turns;
  const double wanted = turn * pattern.num_turns / num_circuits;
  double last_angle = angle * 1.01;
  double last_advance = winder.advance(last_angle);
  constexpr int kSteps = 40;
  for (int step = 0; step < kSteps && std::abs(advance - wanted) > 1e-14 * wanted && advance != last_advance; ++step) {
    const double next = angle + (wanted - advance) * (angle - last_angle) / (advance - last_advance);
    last_angle = angle;
    last_advance = advance;
    angle = next;
    advance = winder.advance(angle);
  }
  pattern.angle = angle;
  pattern.length = num_circuits * winder.circuit(angle);
  const ExponentialResult fibre = winder.trace(angle, pattern.length);
  pattern.fibre = fibre.points;
  const Vector start = fibre.points.col(0);
  const Vector leaving = Winder::direction(angle);
  pattern.closing_miss = (fibre.point - start).norm();
  pattern.closing_turn = std::atan2((fibre.direction - leaving).norm(), (fibre.direction + leaving).norm()) * 2;
  const double constant = start(0) * leaving(1) - start(1) * leaving(0);
  constexpr int kProbes = 24;  // along the fibre
  for (int i = 1; i <= kProbes; ++i) {
    const ExponentialResult part = winder.trace(angle, pattern.length * i / kProbes);
    const double here = part.point(0) * part.direction(1) - part.point(1) * part.direction(0);
    pattern.clairaut_spread = std::max(pattern.clairaut_spread, std::abs(here / constant - 1));
  }
  return pattern;
}

}  // namespace taut::paper
