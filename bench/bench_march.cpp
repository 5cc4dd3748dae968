// Distances on cells: time, cells a second and mean relative error of the three methods on the unit sphere, and of the
// convergent one in more dimensions. Cells and their projected points are prepared outside the clock.

#include <benchmark/benchmark.h>

#include <cmath>

#include "support/surfaces.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/march/march.hpp"

namespace {

using taut::Index;
using taut::MarchMethod;
using taut::Vector;

void run(benchmark::State& state, Index d, double h, MarchMethod method) {
  const taut::Surface sphere = taut::test::unit_sphere(d);
  const Vector source = Vector::LinSpaced(d, 1, 1.7).normalized();
  taut::SurfaceCells growing = taut::SurfaceCells::lazy(sphere, source, h);
  for (Index i = 0; i < growing.num_cells(); ++i) growing.expand(i);
  taut::SurfaceCells cells(sphere, growing.grid().sorted());
  taut::DistanceField field;
  for (auto _ : state) {
    field = taut::march(sphere, cells, source, {.method = method});
    benchmark::DoNotOptimize(field.distance.data());
  }
  double error = 0;
  for (Index i = 0; i < cells.num_cells(); ++i) {
    if (!cells.valid(i)) continue;
    const Vector p = cells.point(i);
    const double truth = 2 * std::atan2((p - source).norm(), (p + source).norm());
    error += std::abs(field.distance(i) / truth - 1) / static_cast<double>(cells.num_valid());
  }
  state.counters["cells"] = static_cast<double>(cells.num_cells());
  state.counters["cells/s"] =
      benchmark::Counter(static_cast<double>(cells.num_cells()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["mean_error"] = error;
}

// Arguments: dimension, cells along the radius.
void BM_Convergent(benchmark::State& state) {
  run(state, state.range(0), 1.0 / static_cast<double>(state.range(1)), MarchMethod::convergent);
}
void BM_Axis(benchmark::State& state) {
  run(state, state.range(0), 1.0 / static_cast<double>(state.range(1)), MarchMethod::axis);
}
void BM_Dijkstra(benchmark::State& state) {
  run(state, state.range(0), 1.0 / static_cast<double>(state.range(1)), MarchMethod::dijkstra);
}

BENCHMARK(BM_Convergent)->Args({3, 7})->Args({3, 14})->Args({3, 50})->Args({3, 100})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Axis)->Args({3, 7})->Args({3, 14})->Args({3, 50})->Args({3, 100})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Dijkstra)->Args({3, 7})->Args({3, 14})->Args({3, 50})->Args({3, 100})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Convergent)->Args({4, 5})->Args({4, 10})->Args({5, 4})->Args({6, 2})->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
