// Newton's correction against the dimension d: ellipsoids with random axes (0.5 .. 2), random pairs, from the projected
// chord, tolerance 1e-9, evaluator and tapes there already. Argument: d. Counters: `median_ms` over the pairs (best of
// the repeats each), `iterations`, `error` = largest relative difference to a run at 1e-13.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "taut/curve/newton.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

std::string ellipsoid(Index dim, std::mt19937_64& random) {
  std::uniform_int_distribution<int> percent(50, 200);
  std::string formula;
  for (Index i = 1; i <= dim; ++i) {
    formula += "+x" + std::to_string(i);
    formula += "^2/" + std::to_string(percent(random) / 100.0) + "^2";
  }
  return formula + "=1";
}

void correct(benchmark::State& state) {
  constexpr std::size_t kPairs = 8;
  constexpr Index kPoints = 49;
  const auto dim = static_cast<Index>(state.range(0));
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const Surface surface = parse_surface(ellipsoid(dim, random));
  NewtonSolver solver(surface);
  NewtonSolver exact(surface, {.tolerance = 1e-13});
  std::vector<Points> paths;
  double error = 0;
  double iterations = 0;
  while (paths.size() < kPairs) {
    Vector p(dim);
    Vector q(dim);
    for (double& c : p) c = normal(random);
    for (double& c : q) c = normal(random);
    p = project_to_surface(surface, p.normalized()).point;
    q = project_to_surface(surface, q.normalized()).point;
    Points path(dim, kPoints);
    for (Index i = 0; i < kPoints; ++i) {
      const double share = static_cast<double>(i) / (kPoints - 1);
      path.col(i) = project_to_surface(surface, (1 - share) * p + share * q).point;
    }
    const NewtonResult result = solver.solve(path);
    const NewtonResult truth = exact.solve(path);
    if (result.status != Status::ok) state.SkipWithError("not converged");
    error = std::max(error, std::abs(result.length / truth.length - 1));
    iterations += static_cast<double>(result.num_iterations) / kPairs;
    paths.push_back(std::move(path));
  }
  std::vector<double> best(paths.size(), 1e9);
  std::size_t next = 0;
  for (auto _ : state) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(solver.solve(paths[next]));
    best[next] = std::min(best[next], std::chrono::duration<double>(Clock::now() - begin).count());
    next = (next + 1) % paths.size();
  }
  std::erase_if(best, [](double seconds) { return seconds > 1e8; });
  std::nth_element(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(best.size() / 2), best.end());
  state.counters["median_ms"] = 1e3 * best[best.size() / 2];
  state.counters["iterations"] = iterations;
  state.counters["error"] = error;
}

BENCHMARK(correct)->Arg(3)->Arg(6)->Arg(9)->Arg(10)->Arg(20)->Arg(50)->Arg(100)->Arg(200)->Arg(500)->Arg(1000);

}  // namespace
}  // namespace taut

BENCHMARK_MAIN();
