#include "walk/follow_curve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/linear_algebra.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::detail {
namespace {

constexpr double kLongest = 4000;  // times |q - p|
constexpr int kMostSteps = 40000;
/// A ray passes a point when it comes as close as this, relative to the coordinates.
constexpr double kPassing = 1e-9;

/// Follows a curve in one direction, a stretch at a time.
class Ray {
 public:
  Ray(const Surface& surface, const Context& context) : map_(surface, {.conjugate = false}), context_(context) {}

  /// From p along `direction` to q; empty when it does not come there.
  Points run(const Vector& p, const Vector& q, Vector direction) {
    const double apart = (q - p).norm();
    Vector here = p;
    std::vector<Vector> way{p};
    double gone = 0;
    int steps = 0;
    for (double stretch = apart / 4; gone < kLongest * apart && steps < kMostSteps;
         gone += stretch, stretch = std::min(1.5 * stretch, 10 * apart)) {
      const ExponentialResult ray = map_.trace(here, direction, stretch, context_);
      steps += ray.num_steps;
      for (Index i = 1; i < ray.points.cols(); ++i) {
        const Vector from = way.back();
        const Vector to = ray.points.col(i);
        if (passes(from, to, q)) {
          way.push_back(q);
          return joined(way);
        }
        if (way.size() > 2 && passes(from, to, p)) return {};
        way.push_back(to);
      }
      if (ray.status != Status::ok) return {};
      here = ray.point;
      direction = ray.direction;
    }
    return {};
  }

 private:
  /// Does x lie on the piece of the curve from `from` to `to`, points close enough for the chord to tell the direction.
  bool passes(const Vector& from, const Vector& to, const Vector& x) {
    const Vector chord = to - from;
    const double length = chord.norm();
    if (!(length > 0) || (x - from).norm() > 1.5 * length) return false;
    const double close = kPassing * x.cwiseAbs().maxCoeff() + 1e-15;
    double s = std::clamp((x - from).dot(chord) / length, 0.0, length);
    for (int iteration = 0; iteration < 8; ++iteration) {
      const ExponentialResult ray = map_.trace(from, chord, s, context_);
      if (ray.status != Status::ok) return false;
      const Vector off = x - ray.point;
      if (off.norm() <= close) return s >= -close && s <= 1.5 * length;
      s += off.dot(ray.direction);
      if (std::abs(s) > 2 * length) return false;
    }
    return false;
  }

  static Points joined(const std::vector<Vector>& way) {
    Points points(way.front().size(), static_cast<Index>(way.size()));
    for (std::size_t i = 0; i < way.size(); ++i) points.col(static_cast<Index>(i)) = way[i];
    return points;
  }

  ExponentialMap map_;
  const Context& context_;
};

}  // namespace

std::vector<Points> follow_curve(const Surface& surface, const Vector& p, const Vector& q, const Context& context) {
  const Points gradients = surface.jacobian(p).reshaped(surface.dim(), surface.codim());
  const Vector tangent = orthogonal_complement(gradients);
  std::vector<Points> ways;
  Ray ray(surface, context);
  for (const double sign : {1.0, -1.0}) {
    try {
      Points way = ray.run(p, q, sign * tangent);
      if (way.cols() >= 2) ways.push_back(std::move(way));
    } catch (const SingularPoint&) {
      continue;
    }
  }
  return ways;
}

}  // namespace taut::detail
