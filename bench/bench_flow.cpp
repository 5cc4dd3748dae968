// The paper's correction: time and error against the spacing, and its explicit time steps against the implicit ones.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "support/surfaces.hpp"
#include "taut/curve/flow.hpp"

namespace {

using taut::FlowOptions;
using taut::FlowResult;
using taut::FlowTimeStep;
using taut::Points;

/// A wiggly start between (1, 0, 0) and (0, 1, 0).
Points wiggly_start() {
  Points start(3, 21);
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.5 * std::numbers::pi * i / 20;
    start.col(i) << std::cos(t), std::sin(t), i == 0 || i == 20 ? 0.0 : 0.2 * std::sin(7 * t);
  }
  start.col(20) << 0, 1, 0;
  return start;
}

void quarter_circle(benchmark::State& state, FlowTimeStep time_step) {
  const taut::Surface sphere = taut::test::unit_sphere();
  const Points start = wiggly_start();
  FlowOptions options;
  options.time_step = time_step;
  options.spacing = 0.5 * std::numbers::pi / static_cast<double>(state.range(0));
  FlowResult result;
  for (auto _ : state) {
    result = taut::correct_flow(sphere, start, options);
    benchmark::DoNotOptimize(result.length);
  }
  state.counters["error"] = 0.5 * std::numbers::pi - result.length;
  state.counters["model_error"] = result.summary.error_sum;
  state.counters["steps"] = result.num_iterations;
  state.counters["converged"] = result.status == taut::Status::ok ? 1 : 0;
}

void linearly_implicit(benchmark::State& state) { quarter_circle(state, FlowTimeStep::linearly_implicit); }
void explicit_euler(benchmark::State& state) { quarter_circle(state, FlowTimeStep::explicit_euler); }

BENCHMARK(linearly_implicit)->RangeMultiplier(2)->Range(16, 1024)->Unit(benchmark::kMillisecond);
BENCHMARK(explicit_euler)->RangeMultiplier(2)->Range(16, 128)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
