// Cells a second and bytes a cell. Algorithm I against a naive scan of the same box in the same run; both algorithms'
// cost against N; neighbours, projection.
//   bench_cells --benchmark_counters_tabular=true

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "cells/crossing.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/surface/formula.hpp"

namespace {

using namespace taut;

constexpr double kEdge = 4.8;  // the tangle cube's box

Surface tangle_cube() {
  const Box box{Vector::Constant(3, -kEdge / 2), Vector::Constant(3, kEdge / 2)};
  return parse_surface("x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8").with_box(box);
}

void report(benchmark::State& state, const CellGrid& grid) {
  const auto n = static_cast<double>(grid.num_cells());
  state.counters["cells"] = n;
  state.counters["cells/s"] = benchmark::Counter(n, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes/cell"] = static_cast<double>(grid.bytes()) / n;
  state.SetComplexityN(grid.num_cells());
}

/// Cells across the box: the argument.
void subdivide_tangle_cube(benchmark::State& state) {
  const Surface surface = tangle_cube();
  CellGrid grid(Vector::Zero(3), 1);
  for (auto _ : state) {
    grid = subdivide(surface, {.size = kEdge / static_cast<double>(state.range(0))}, {.threads = 1});
  }
  report(state, grid);
}
BENCHMARK(subdivide_tangle_cube)->RangeMultiplier(2)->Range(32, 1024)->Unit(benchmark::kMillisecond)->Complexity();

/// The scan that the paper warns of: the same test on every cell of the box.
void naive_scan_tangle_cube(benchmark::State& state) {
  const Surface surface = tangle_cube();
  const auto across = static_cast<std::int32_t>(state.range(0));
  CellGrid grid(Vector::Zero(3), 1);
  for (auto _ : state) {
    grid = CellGrid(Vector::Constant(3, -kEdge / 2), kEdge / across);
    detail::CrossingTest test(surface, grid.origin(), grid.size());
    std::vector<std::int32_t> row;
    std::vector<std::uint8_t> crossed(static_cast<std::size_t>(across));
    for (std::int32_t z = 0; z < across; ++z) {
      for (std::int32_t y = 0; y < across; ++y) {
        row.clear();
        for (std::int32_t x = 0; x < across; ++x) row.insert(row.end(), {x, y, z});
        test.test(row, 0, crossed);
        for (std::size_t x = 0; x < crossed.size(); ++x) {
          if (crossed[x] != 0) grid.insert(row.data() + 3 * x);
        }
      }
    }
  }
  report(state, grid);
}
BENCHMARK(naive_scan_tangle_cube)->RangeMultiplier(2)->Range(32, 256)->Unit(benchmark::kMillisecond)->Complexity();

void grow_tangle_cube(benchmark::State& state) {
  const Surface surface = tangle_cube();
  const Vector seed =
      Eigen::Vector3d(std::sqrt(2.5 + std::sqrt(6.25 - 11.8 / 3)), std::sqrt(2.5 + std::sqrt(6.25 - 11.8 / 3)),
                      std::sqrt(2.5 + std::sqrt(6.25 - 11.8 / 3)));
  CellGrid grid(Vector::Zero(3), 1);
  for (auto _ : state) {
    grid = grow(surface, seed, kEdge / static_cast<double>(state.range(0)), {.threads = 1});
  }
  report(state, grid);
}
BENCHMARK(grow_tangle_cube)->RangeMultiplier(2)->Range(32, 512)->Unit(benchmark::kMillisecond)->Complexity();

/// A search that asks for every neighbour: lazy growth and projection together.
void lazy_tangle_cube(benchmark::State& state) {
  const Surface surface = tangle_cube();
  const double c = std::sqrt(2.5 + std::sqrt(6.25 - 11.8 / 3));
  double cells_found = 0;
  for (auto _ : state) {
    SurfaceCells cells =
        SurfaceCells::lazy(surface, Eigen::Vector3d(c, c, c), kEdge / static_cast<double>(state.range(0)));
    for (Index i = 0; i < cells.num_cells(); ++i) cells.expand(i);
    cells_found = static_cast<double>(cells.num_cells());
  }
  state.counters["cells"] = cells_found;
  state.counters["cells/s"] = benchmark::Counter(cells_found, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(lazy_tangle_cube)->Arg(64)->Arg(256)->Unit(benchmark::kMillisecond);

void project_cells_of_tangle_cube(benchmark::State& state) {
  const Surface surface = tangle_cube();
  const CellGrid grid = subdivide(surface, {.size = kEdge / static_cast<double>(state.range(0))});
  for (auto _ : state) {
    const SurfaceCells cells(surface, grid, {.threads = 1});
    benchmark::DoNotOptimize(cells.point(0).data());
  }
  report(state, grid);
}
BENCHMARK(project_cells_of_tangle_cube)->Arg(64)->Arg(256)->Unit(benchmark::kMillisecond);

void neighbours_of_tangle_cube(benchmark::State& state) {
  const CellGrid grid = subdivide(tangle_cube(), {.size = kEdge / static_cast<double>(state.range(0))});
  std::vector<Index> around(26);
  Index sum = 0;
  for (auto _ : state) {
    for (Index i = 0; i < grid.num_cells(); ++i) {
      grid.neighbours(i, around);
      sum += around[3] + around[20];
    }
  }
  benchmark::DoNotOptimize(sum);
  report(state, grid);
}
BENCHMARK(neighbours_of_tangle_cube)->Arg(64)->Arg(256)->Arg(1024)->Unit(benchmark::kMillisecond);

void subdivide_sphere_in_r4(benchmark::State& state) {
  const Surface surface =
      parse_surface("x^2 + y^2 + z^2 + w^2 = 1").with_box({Vector::Constant(4, -1.01), Vector::Constant(4, 1.01)});
  CellGrid grid(Vector::Zero(4), 1);
  for (auto _ : state) grid = subdivide(surface, {.size = 2.02 / static_cast<double>(state.range(0))}, {.threads = 1});
  report(state, grid);
}
BENCHMARK(subdivide_sphere_in_r4)->Arg(16)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond)->Complexity();

}  // namespace

BENCHMARK_MAIN();
