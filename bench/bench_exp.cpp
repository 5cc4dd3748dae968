// The exponential map alone: a ray of length 2 on the ellipsoid 1:1:0.5 from starts all over it, evaluator and
// workspace there already. Arguments: -log10 of the tolerance a step (0 = as near to rounding as F allows), conjugate
// points looked for or not. Counters: `error` = largest distance to the end at tolerance 0, `steps`, `points` =
// evaluations of F a ray.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "taut/curve/exponential_map.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double kLength = 2;

struct Start {
  Vector x, v;
};

/// On a spiral from pole to pole, in directions that turn by no simple part of a circle.
std::vector<Start> starts(int count) {
  constexpr double kGolden = 2.399963;  // radians
  std::vector<Start> result;
  for (int i = 0; i < count; ++i) {
    const double z = -1 + (2 * i + 1.0) / count;
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d x(r * std::cos(kGolden * i), r * std::sin(kGolden * i), z / 2);
    const Eigen::Vector3d normal = Eigen::Vector3d(x[0], x[1], 4 * x[2]).normalized();
    const Eigen::Vector3d t = normal.unitOrthogonal();
    const double angle = 1.7 * i;
    result.push_back({x, std::cos(angle) * t + std::sin(angle) * normal.cross(t)});
  }
  return result;
}

void exponential(benchmark::State& state) {
  const Surface surface = parse_surface("x^2+y^2+4z^2=1");
  const std::vector<Start> all = starts(10000);
  const double tolerance = state.range(0) == 0 ? 0 : std::pow(10.0, -static_cast<double>(state.range(0)));
  ExponentialMap rays(surface, {.tolerance = tolerance, .conjugate = state.range(1) != 0, .points = false});
  ExponentialMap exact(surface, {.tolerance = 0, .conjugate = false, .points = false});
  double error = 0;
  for (std::size_t i = 0; i < all.size(); i += 100) {
    const Vector end = exact.trace(all[i].x, all[i].v, kLength).point;
    error = std::max(error, (rays.trace(all[i].x, all[i].v, kLength).point - end).norm());
  }
  std::size_t i = 0;
  double steps = 0;
  double points = 0;
  for (auto _ : state) {
    const ExponentialResult ray = rays.trace(all[i].x, all[i].v, kLength);
    steps += ray.num_steps;
    points += static_cast<double>(ray.num_evaluated);
    i = (i + 1) % all.size();
  }
  state.counters["error"] = error;
  state.counters["steps"] = benchmark::Counter(steps, benchmark::Counter::kAvgIterations);
  state.counters["points"] = benchmark::Counter(points, benchmark::Counter::kAvgIterations);
}
BENCHMARK(exponential)->Args({12, 0})->Args({12, 1})->Args({0, 0})->Args({0, 1})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace taut

BENCHMARK_MAIN();
