// Starts from a point that the surface bends round within a cell, such as the tip of a spike: rays of one length in all
// directions, long enough to end where cells can tell ways apart, and from each tip down the field to the other end.
// The total length as a function of the angle has a minimum for each way; more rays where neighbours wind apart.
#include "search/fan_out.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "march/march_over.hpp"
#include "march/point_normals.hpp"
#include "search/scout.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::detail {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Rays at first, at equal angles. Between two beside each other at whose ends the normals differ by more, radians,
/// there is one more, and again: on a needle they wind apart.
constexpr Index kRays = 24;
constexpr double kMostApart = 1;
constexpr int kRefinements = 2;
/// Length of the rays, in cells: doubled while more than this part of them ends where the surface bends sharply, as
/// long as they are no longer than that part of the shortest way.
constexpr double kRayCells = 3;
constexpr double kMostSharp = 0.1;
constexpr double kMostOfWay = 0.5;

struct Ray {
  double angle;
  Points points;  // none if it ran into a singular point, left the domain or was given up
};

/// Geodesics of one length from a point, in the order of their angles.
class Fan {
 public:
  Fan(const Surface& surface, const Vector& p, const Eigen::Vector3d& normal, const Context& context)
      : surface_(surface),
        p_(p),
        first_(normal.unitOrthogonal()),
        second_(normal.cross(first_)),
        context_(context),
        map_(surface, kScout) {}

  void trace(double length) {
    length_ = length;
    rays_.clear();
    for (Index i = 0; i < kRays; ++i) rays_.push_back(ray(kTurn * static_cast<double>(i) / kRays));
  }

  void refine() {
    for (int round = 0; round < kRefinements; ++round) {
      const Points normals = normals_at(surface_, tips());
      const Index n = size();
      std::vector<Ray> finer;
      for (Index i = 0; i < n; ++i) {
        const Index next = (i + 1) % n;
        const double angle = (rays_[at(i)].angle + (next == 0 ? kTurn : rays_[at(next)].angle)) / 2;
        finer.push_back(std::move(rays_[at(i)]));
        // NaN where one of them has no end.
        if (normals.col(i).dot(normals.col(next)) < std::cos(kMostApart)) finer.push_back(ray(angle));
      }
      rays_ = std::move(finer);
      if (size() == n) break;
    }
  }

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] Index size() const { return static_cast<Index>(rays_.size()); }
  [[nodiscard]] const Points& points(Index i) const { return rays_[at(i)].points; }
  /// Where the rays end, 3 x n; NaN where there are no points.
  [[nodiscard]] Points tips() const {
    Points tips = Points::Constant(3, size(), std::numeric_limits<double>::quiet_NaN());
    for (Index i = 0; i < size(); ++i) {
      if (points(i).cols() > 0) tips.col(i) = points(i).rightCols(1);
    }
    return tips;
  }

  [[nodiscard]] bool ends_in_bends(const SharpBends& bends) const {
    const std::vector<std::uint8_t> sharp = bends.at(tips());
    Index count = 0;
    for (Index i = 0; i < size(); ++i) count += points(i).cols() > 0 && sharp[at(i)] != 0 ? 1 : 0;
    return static_cast<double>(count) > kMostSharp * kRays;
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] Ray ray(double angle) {
    ExponentialResult traced = map_.trace(p_, std::cos(angle) * first_ + std::sin(angle) * second_, length_, context_);
    const bool arrived = traced.status == Status::ok && traced.points.cols() >= 2;
    return {angle, arrived ? std::move(traced.points) : Points(3, 0)};
  }

  const Surface& surface_;
  const Vector& p_;
  const Eigen::Vector3d first_;
  const Eigen::Vector3d second_;
  const Context& context_;
  ExponentialMap map_;
  double length_ = 0;
  std::vector<Ray> rays_;
};

}  // namespace

std::vector<StartPath> fan_out(const Surface& surface, const Ground& ground, const Vector& p,
                               const DistanceField& field, double most, const Context& context) {
  std::vector<StartPath> starts;
  const Eigen::Vector3d normal = normals_at(surface, p).col(0);
  if (!normal.allFinite()) return starts;
  const SurfaceCells& cells = *ground.cells;
  Fan fan(surface, p, normal, context);
  fan.trace(kRayCells * cells.grid().size());
  while (fan.ends_in_bends(*ground.bends) && 2 * fan.length() <= kMostOfWay * most) fan.trace(2 * fan.length());
  fan.refine();
  const Points tips = fan.tips();
  const Vector beyond = distance_at(surface, cells, field, tips);
  const Index n = fan.size();
  const auto whole = [&](Index i) {
    const double rest = beyond(i % n);
    return std::isnan(rest) ? std::numeric_limits<double>::infinity() : fan.length() + rest;
  };
  for (Index i = 0; i < n; ++i) {
    // Minima round the circle; of equal neighbours the last.
    if (!(whole(i) <= most) || whole(i + n - 1) < whole(i) || whole(i + 1) <= whole(i)) continue;
    const Points down = descend_over(surface, cells, ground.map.get(), field, tips.col(i));
    if (down.cols() < 2) continue;
    const Points& ray = fan.points(i);
    Points points(3, ray.cols() + down.cols() - 1);
    points << ray, down.leftCols(down.cols() - 1).rowwise().reverse();
    points.col(0) = p;
    starts.push_back({whole(i), std::move(points)});
  }
  std::ranges::stable_sort(starts, {}, &StartPath::length);
  return starts;
}

}  // namespace taut::detail
