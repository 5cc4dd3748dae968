// Targets asked of a fan that is grown for them: first a little beyond the straight distance to the farthest one, then
// by steps while any is left.
//
// On a surface with a border the fan's rays go on beyond it. The shortest of them is the distance where it stays
// inside; whether one that may have left has, a ray that looks at the domain tells.

#include "fan/fan_answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::detail {
namespace {

/// Follows the geodesic that may have left the domain; if it has not, it is the hit.
bool stays_inside(ExponentialMap& rays, FanHit& hit, const Context& context) {
  const ExponentialResult ray =
      rays.trace(Vector(hit.astray_foot), Vector(hit.astray_departure), hit.astray - hit.astray_value, context);
  if (ray.status != Status::ok) return false;
  hit.distance = hit.astray;
  hit.error = hit.astray_error + ray.error;
  hit.source = hit.astray_source;
  hit.foot = hit.astray_foot;
  hit.departure = hit.astray_departure;
  hit.arrival = ray.direction;
  return true;
}

}  // namespace

Index most_evaluated(const Surface& surface) {
  constexpr Index kFormula = 500'000'000;
  constexpr Index kLocal = 10'000'000;
  constexpr Index kDense = 700'000;
  if (surface.kind() == "rbf") return kDense;
  return surface.kind() == "patches" || surface.kind() == "volume" ? kLocal : kFormula;
}

std::vector<FanAnswer> ask_fan(GeodesicFan& fan, const Surface& surface, const PointsIn& sources,
                               const VectorIn& values, const PointsIn& targets, double max_distance,
                               const Context& context) {
  constexpr double kBeyondStraight = 1.1;
  constexpr double kGrowth = 1.4;
  const auto size = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<FanAnswer> answers(size(targets.cols()));
  std::vector<Index> open;
  double straight = 0;
  for (Index j = 0; j < targets.cols(); ++j) {
    open.push_back(j);
    double nearest = std::numeric_limits<double>::infinity();
    for (Index s = 0; s < sources.cols(); ++s) {
      nearest = std::min(nearest, values(s) + (targets.col(j) - sources.col(s)).norm());
    }
    straight = std::max(straight, nearest);
  }
  double goal = kBeyondStraight * straight;
  while (!open.empty()) {
    fan.extend(std::min(goal, max_distance), context);
    goal = std::max(kGrowth * goal, straight);
    Points asked(3, static_cast<Index>(open.size()));
    for (Index i = 0; i < asked.cols(); ++i) asked.col(i) = targets.col(open[size(i)]);
    const std::vector<FanHit> hits = fan.locate(asked, context);
    const double reach = fan.reach();
    std::vector<std::uint8_t> done(hits.size(), 0);
    constexpr Index kGrain = 64;
    detail::parallel_for(context, 0, static_cast<Index>(hits.size()), kGrain, [&](Index begin, Index end) {
      std::optional<ExponentialMap> rays;
      for (Index i = begin; i < end; ++i) {
        FanAnswer& answer = answers[size(open[size(i)])];
        answer.hit = hits[size(i)];
        const double least = std::min(answer.hit.distance, answer.hit.astray);
        const double known = std::min(reach, fan.broken() ? fan.bound(asked.col(i)) : reach);
        // Without a limit, what no geodesic of a complete fan meets stays open: it may lie on another component.
        if (std::isfinite(max_distance) && std::min(least, known) >= max_distance) {
          answer.kind = FanAnswer::Kind::beyond;
          done[size(i)] = 1;
          continue;
        }
        if (!std::isfinite(least) || least > known) continue;
        done[size(i)] = 1;
        answer.kind = FanAnswer::Kind::proved;
        if (answer.hit.distance <= answer.hit.astray) continue;
        if (!rays) rays.emplace(surface, ExponentialOptions{.tolerance = 1e-12, .conjugate = false, .points = false});
        if (!stays_inside(*rays, answer.hit, context)) answer.kind = FanAnswer::Kind::open;
      }
    });
    std::vector<Index> left;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (done[i] == 0) left.push_back(open[i]);
    }
    open = std::move(left);
    if (fan.finished()) break;
  }
  return answers;
}

}  // namespace taut::detail
