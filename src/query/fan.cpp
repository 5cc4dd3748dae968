#include "query/fan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "march/march_over.hpp"
#include "march/point_normals.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::detail {
namespace {

constexpr std::size_t kRays = 24;
constexpr double kRayTolerance = 1e-3;
constexpr int kMostRaySteps = 30;  // a ray that winds round a spike more often is given up
/// Length of the rays, in cells: doubled while more than this part of them ends where the surface bends sharply, as
/// long as they are no longer than that part of the shortest way.
constexpr double kRayCells = 3;
constexpr double kMostSharp = 0.1;
constexpr double kMostOfWay = 0.5;

struct Fan {
  double length = 0;
  std::vector<Points> rays;  // without points: it ran into a singular point, left the domain or was given up
  Points tips;               // where they end, 3 x kRays; NaN where there are no points
};

/// Rays from p in all directions.
Fan trace(ExponentialMap& map, const Vector& p, const Eigen::Vector3d& normal, double length, const Context& context) {
  const Eigen::Vector3d first = normal.unitOrthogonal();
  const Eigen::Vector3d second = normal.cross(first);
  Fan fan{length, std::vector<Points>(kRays, Points(3, 0)),
          Points::Constant(3, kRays, std::numeric_limits<double>::quiet_NaN())};
  for (std::size_t i = 0; i < kRays; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kRays;
    ExponentialResult ray = map.trace(p, std::cos(angle) * first + std::sin(angle) * second, length, context);
    if (ray.status != Status::ok || ray.points.cols() < 2) continue;
    fan.tips.col(static_cast<Index>(i)) = ray.points.rightCols(1);
    fan.rays[i] = std::move(ray.points);
  }
  return fan;
}

bool ends_in_bends(const Fan& fan, const SharpBends& bends) {
  const std::vector<std::uint8_t> sharp = bends.at(fan.tips);
  int count = 0;
  for (std::size_t i = 0; i < kRays; ++i) count += fan.rays[i].cols() > 0 && sharp[i] != 0 ? 1 : 0;
  return count > kMostSharp * kRays;
}

}  // namespace

std::vector<StartPath> fan_out(const Surface& surface, const Ground& ground, const Vector& p,
                               const DistanceField& field, double most, const Context& context) {
  std::vector<StartPath> starts;
  const Eigen::Vector3d normal = normals_at(surface, p).col(0);
  if (!normal.allFinite()) return starts;
  ExponentialMap exponential(surface, {.tolerance = kRayTolerance, .max_steps = kMostRaySteps, .conjugate = false});
  const SurfaceCells& cells = *ground.cells;
  double length = kRayCells * cells.grid().size();
  Fan fan = trace(exponential, p, normal, length, context);
  while (ends_in_bends(fan, *ground.bends) && 2 * length <= kMostOfWay * most) {
    length *= 2;
    fan = trace(exponential, p, normal, length, context);
  }
  const Vector beyond = distance_at(surface, cells, field, fan.tips);
  const auto whole = [&](std::size_t i) {
    const double rest = beyond(static_cast<Index>(i % kRays));
    return std::isnan(rest) ? std::numeric_limits<double>::infinity() : fan.length + rest;
  };
  for (std::size_t i = 0; i < kRays; ++i) {
    if (!(whole(i) <= most) || whole(i + kRays - 1) < whole(i) || whole(i + 1) <= whole(i)) continue;
    const Points down = descend_over(surface, cells, ground.map.get(), field, fan.tips.col(static_cast<Index>(i)));
    if (down.cols() < 2) continue;
    const Points& ray = fan.rays[i];
    Points points(3, ray.cols() + down.cols() - 1);
    points << ray, down.leftCols(down.cols() - 1).rowwise().reverse();
    points.col(0) = p;
    starts.push_back({whole(i), std::move(points)});
  }
  std::ranges::stable_sort(starts, {}, &StartPath::length);
  return starts;
}

}  // namespace taut::detail
