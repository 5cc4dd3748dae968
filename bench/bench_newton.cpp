// Newton's correction alone: one path from a rough start (30 points, each moved by 2 % of the length), evaluator and
// workspace there already. Argument: -log10 of the tolerance. Counters: `error` = largest relative difference to a run
// at 1e-13, `points` = evaluations of F a path, `evaluation` = share of the time spent evaluating F.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/geodesic_start.hpp"
#include "taut/curve/newton.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

// Rough paths of random length in random directions from random points of the surface.
std::vector<Points> starts(const Surface& surface, double length) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.3, 1.0);
  std::vector<Points> result;
  while (result.size() < 40) {
    Vector x(3);
    Vector v(3);
    for (Index i = 0; i < 3; ++i) {
      x(i) = normal(random);
      v(i) = normal(random);
    }
    for (int step = 0; step < 60; ++step) {
      const Vector g = surface.jacobian(x);
      x -= surface.value(x)(0) / g.squaredNorm() * g;
    }
    if (!x.allFinite() || std::abs(surface.value(x)(0)) > 1e-12) continue;
    const Vector n = Vector(surface.jacobian(x)).normalized();
    v = (v - n.dot(v) * n).normalized();
    const double size = length * share(random);
    Points path = test::integrate_geodesic(surface, x, v, size, 30);
    if (!path.allFinite()) continue;
    path = test::with_noise(path, 0.02 * size / 5, static_cast<unsigned>(result.size()));
    if (correct_newton(surface, path, {.tolerance = 1e-12}).status == Status::ok) result.push_back(path);
  }
  return result;
}

void correct(benchmark::State& state, const std::string& formula, double length) {
  const Surface surface = parse_surface(formula);
  const double tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
  const std::vector<Points> paths = starts(surface, length);
  NewtonSolver solver(surface, {.tolerance = tolerance});
  double error = 0;
  double points = 0;
  for (const Points& path : paths) {
    const double truth = correct_newton(surface, path, {.tolerance = 1e-13}).length;
    const NewtonResult result = solver.solve(path);
    if (std::abs(result.length - truth) < 1e-3 * truth)
      error = std::max(error, std::abs(result.length - truth) / truth);
    points += static_cast<double>(result.num_evaluated) / static_cast<double>(paths.size());
  }
  std::vector<double> best(paths.size(), 1.0);
  std::size_t next = 0;
  for (auto _ : state) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(solver.solve(paths[next]));
    best[next] = std::min(best[next], std::chrono::duration<double>(Clock::now() - begin).count());
    next = (next + 1) % paths.size();
  }
  std::nth_element(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(best.size() / 2), best.end());
  const double median = best[best.size() / 2];

  // The same number of points evaluated alone, 64 at a time.
  Points x(3, 64);
  for (Index j = 0; j < 64; ++j) x.col(j) = paths[0].col(j % paths[0].cols());
  Points value(1, 64);
  Points gradient(3, 64);
  Points hessian(9, 64);
  const Points weight = Points::Ones(1, 64);
  const auto evaluator = surface.make_evaluator();
  double visit = 1;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const auto begin = Clock::now();
    evaluator->evaluate({.n = 64,
                         .x = x.data(),
                         .value = value.data(),
                         .jacobian = gradient.data(),
                         .weight = weight.data(),
                         .hessian = hessian.data()});
    visit = std::min(visit, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  state.counters["error"] = error;
  state.counters["points"] = points;
  state.counters["median_us"] = 1e6 * median;
  state.counters["evaluation"] = visit / 64 * points / median;
}

BENCHMARK_CAPTURE(correct, ellipsoid, "x^2+y^2+4z^2=1", 2.0)->Arg(3)->Arg(6)->Arg(9)->Arg(12);
BENCHMARK_CAPTURE(correct, torus, "(x^2+y^2+z^2+1-0.4^2)^2-4*(x^2+y^2)", 2.0)->Arg(3)->Arg(6)->Arg(9)->Arg(12);
BENCHMARK_CAPTURE(correct, tangle_cube, "x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8", 4.0)->Arg(3)->Arg(6)->Arg(9)->Arg(12);

}  // namespace
}  // namespace taut

BENCHMARK_MAIN();
