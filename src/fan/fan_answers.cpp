// Targets asked of a fan that is grown for them: first a little beyond the straight distance to the farthest one, then
// by steps while any is left.
//
// On a surface with a border the fan's rays go on beyond it. The shortest of them is the distance where it stays
// inside; whether one that may have left has, a ray that looks at the domain tells.

#include "fan/fan_answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
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

void ask_fan(GeodesicFan& fan, const Surface& surface, const PointsIn& sources, const VectorIn& values,
             const PointsIn& targets, std::vector<Index> asked, double max_distance, const Context& context,
             const TakeAnswer& take) {
  constexpr double kBeyondStraight = 1.1;
  constexpr double kGrowth = 1.4;
  // Of rays that look at the domain: they add nothing to the fan's error. On a fit each digit more takes twice as long.
  constexpr double kOfFan = 1e-3;
  constexpr double kMostExact = 1e-12;
  const auto size = [](Index i) { return static_cast<std::size_t>(i); };
  double straight = 0;
  for (const Index j : asked) {
    double nearest = std::numeric_limits<double>::infinity();
    for (Index s = 0; s < sources.cols(); ++s) {
      nearest = std::min(nearest, values(s) + (targets.col(j) - sources.col(s)).norm());
    }
    straight = std::max(straight, nearest);
  }
  Context own = context;
  own.threads = 1;
  double goal = kBeyondStraight * straight;
  while (!asked.empty()) {
    fan.extend(std::min(goal, max_distance), context);
    goal = std::max(kGrowth * goal, straight);
    const double reach = fan.reach();
    std::vector<std::uint8_t> done(asked.size(), 0);
    // Hits are large: those of a block stay in the cache until they have been taken.
    constexpr Index kGrain = 128;
    detail::parallel_for(context, 0, static_cast<Index>(asked.size()), kGrain, [&](Index begin, Index end) {
      std::optional<ExponentialMap> rays;
      Points x(3, end - begin);
      for (Index i = begin; i < end; ++i) x.col(i - begin) = targets.col(asked[size(i)]);
      const std::vector<FanHit> hits = fan.locate(x, own);
      for (Index i = begin; i < end; ++i) {
        FanAnswer answer{.kind = FanAnswer::Kind::open, .hit = hits[size(i - begin)]};
        const double least = std::min(answer.hit.distance, answer.hit.astray);
        const double known = fan.broken() ? std::min(reach, fan.bound(x.col(i - begin))) : reach;
        if (std::isfinite(max_distance) && std::min(least, known) >= max_distance) {
          // Without a limit, what no geodesic of a complete fan meets stays open: it may lie on another component.
          answer.kind = FanAnswer::Kind::beyond;
          done[size(i)] = 1;
        } else if (std::isfinite(least) && least <= known) {
          done[size(i)] = 1;
          if (answer.hit.astray < answer.hit.distance && !rays) {
            rays.emplace(surface, ExponentialOptions{.tolerance = std::max(kMostExact, kOfFan * fan.tolerance()),
                                                     .conjugate = false,
                                                     .points = false});
          }
          const bool inside = answer.hit.distance <= answer.hit.astray || stays_inside(*rays, answer.hit, context);
          if (inside) answer.kind = FanAnswer::Kind::proved;
        }
        take(asked[size(i)], answer);
      }
    });
    std::vector<Index> left;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (done[i] == 0) left.push_back(asked[i]);
    }
    asked = std::move(left);
    if (fan.finished()) break;
  }
}

std::vector<FanAnswer> ask_fan(GeodesicFan& fan, const Surface& surface, const PointsIn& sources,
                               const VectorIn& values, const PointsIn& targets, double max_distance,
                               const Context& context) {
  std::vector<FanAnswer> answers(static_cast<std::size_t>(targets.cols()));
  std::vector<Index> all(answers.size());
  std::iota(all.begin(), all.end(), Index{0});
  ask_fan(fan, surface, sources, values, targets, std::move(all), max_distance, context,
          [&](Index target, const FanAnswer& answer) { answers[static_cast<std::size_t>(target)] = answer; });
  return answers;
}

}  // namespace taut::detail
