// OpenVDB beside Taut's Algorithm I in the same run: active voxels or cells a second, bytes each, the same spacing, one
// core.
//   opponent_openvdb --benchmark_counters_tabular=true
// What is compared: OpenVDB's own sphere level set (a distance formula written for spheres), and the two ways to a
// narrow band from a formula of one's own: topology from the value at every voxel of the box, and the same restricted
// to the leaves found beforehand on a voxel eight times as wide. A narrow band keeps the voxels within `kHalfWidth`
// voxels, each with a value; Taut keeps the cells that the surface may cross, without values, and proves that it lost
// none, which sampled values cannot.

#include <benchmark/benchmark.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <cstdint>

#include "taut/cells/find_cells.hpp"
#include "taut/surface/formula.hpp"

namespace {

constexpr double kEdge = 4.8;       // side of the box around the tangle cube and the sphere of radius 2
constexpr double kHalfWidth = 1.5;  // voxels: OpenVDB wants more than 1
constexpr double kRadius = 2;

void report(benchmark::State& state, double cells, double bytes) {
  state.counters["cells"] = cells;
  state.counters["cells/s"] = benchmark::Counter(cells, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes/cell"] = bytes / cells;
}

void report(benchmark::State& state, const openvdb::FloatGrid& grid) {
  report(state, static_cast<double>(grid.activeVoxelCount()), static_cast<double>(grid.memUsage()));
}

void report(benchmark::State& state, const taut::CellGrid& grid) {
  report(state, static_cast<double>(grid.num_cells()), static_cast<double>(grid.bytes()));
}

taut::Surface in_box(const char* formula) {
  const taut::Vector corner = taut::Vector::Constant(3, kEdge / 2);
  return taut::parse_surface(formula).with_box({-corner, corner});
}

constexpr const char* kSphere = "x^2 + y^2 + z^2 = 4";
constexpr const char* kTangleCube = "x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8";

double quartic(double t) { return t * t * (t * t - 5); }
double quartic_slope(double t) { return t * (4 * t * t - 10); }

/// First-order distance F / |grad F|, what a narrow band of a formula holds.
double tangle_distance(const openvdb::Vec3d& x) {
  const double f = quartic(x.x()) + quartic(x.y()) + quartic(x.z()) + 11.8;
  const double slope = std::hypot(quartic_slope(x.x()), quartic_slope(x.y()), quartic_slope(x.z()));
  return slope > 0 ? f / slope : f;
}

void taut_subdivide(benchmark::State& state, const char* formula) {
  const taut::Surface surface = in_box(formula);
  taut::CellGrid grid(taut::Vector::Zero(3), 1);
  for (auto _ : state) {
    grid = taut::subdivide(surface, {.size = kEdge / static_cast<double>(state.range(0))}, {.threads = 1});
  }
  report(state, grid);
}
BENCHMARK_CAPTURE(taut_subdivide, sphere, kSphere)->RangeMultiplier(2)->Range(64, 512)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(taut_subdivide, tangle_cube, kTangleCube)
    ->RangeMultiplier(2)
    ->Range(64, 512)
    ->Unit(benchmark::kMillisecond);

void taut_grow(benchmark::State& state, const char* formula, double x, double y, double z) {
  const taut::Surface surface = in_box(formula);
  taut::CellGrid grid(taut::Vector::Zero(3), 1);
  for (auto _ : state) {
    grid = taut::grow(surface, Eigen::Vector3d(x, y, z), kEdge / static_cast<double>(state.range(0)), {.threads = 1});
  }
  report(state, grid);
}
BENCHMARK_CAPTURE(taut_grow, sphere, kSphere, kRadius, 0, 0)
    ->RangeMultiplier(2)
    ->Range(64, 256)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(taut_grow, tangle_cube, kTangleCube, 2.0107, 2.0107, 2.0107)
    ->RangeMultiplier(2)
    ->Range(64, 256)
    ->Unit(benchmark::kMillisecond);

void openvdb_level_set_sphere(benchmark::State& state) {
  openvdb::FloatGrid::Ptr grid;
  for (auto _ : state) {
    const double h = kEdge / static_cast<double>(state.range(0));
    grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        static_cast<float>(kRadius), openvdb::Vec3f(0), static_cast<float>(h), static_cast<float>(kHalfWidth),
        /*threaded=*/false);
  }
  report(state, *grid);
}
BENCHMARK(openvdb_level_set_sphere)->RangeMultiplier(2)->Range(64, 512)->Unit(benchmark::kMillisecond);

/// Visits the voxels lo <= ijk < hi of every axis and keeps those within the half-width.
void fill(openvdb::FloatGrid::Accessor& band, const openvdb::Coord& lo, const openvdb::Coord& hi, double h) {
  for (std::int32_t i = lo.x(); i < hi.x(); ++i) {
    for (std::int32_t j = lo.y(); j < hi.y(); ++j) {
      for (std::int32_t k = lo.z(); k < hi.z(); ++k) {
        const double distance = tangle_distance(openvdb::Vec3d(i + 0.5, j + 0.5, k + 0.5) * h);
        if (std::abs(distance) < kHalfWidth * h) band.setValue({i, j, k}, static_cast<float>(distance));
      }
    }
  }
}

void openvdb_band_by_full_scan(benchmark::State& state) {
  openvdb::FloatGrid::Ptr grid;
  const auto half = static_cast<std::int32_t>(state.range(0) / 2);
  const double h = kEdge / static_cast<double>(state.range(0));
  for (auto _ : state) {
    grid = openvdb::FloatGrid::create(static_cast<float>(kHalfWidth * h));
    auto band = grid->getAccessor();
    fill(band, openvdb::Coord(-half), openvdb::Coord(half), h);
  }
  report(state, *grid);
}
BENCHMARK(openvdb_band_by_full_scan)->RangeMultiplier(2)->Range(64, 256)->Unit(benchmark::kMillisecond);

/// Leaves of 8^3 voxels whose centre is within their circumscribed radius and the band, then their voxels.
void openvdb_band_by_leaves(benchmark::State& state) {
  constexpr std::int32_t kLeaf = 8;
  openvdb::FloatGrid::Ptr grid;
  const auto half = static_cast<std::int32_t>(state.range(0) / 2);
  const double h = kEdge / static_cast<double>(state.range(0));
  const double reach = (0.5 * kLeaf * std::sqrt(3.0) + kHalfWidth) * h;
  for (auto _ : state) {
    grid = openvdb::FloatGrid::create(static_cast<float>(kHalfWidth * h));
    auto band = grid->getAccessor();
    for (std::int32_t i = -half; i < half; i += kLeaf) {
      for (std::int32_t j = -half; j < half; j += kLeaf) {
        for (std::int32_t k = -half; k < half; k += kLeaf) {
          const openvdb::Vec3d centre = (openvdb::Vec3d(i, j, k) + openvdb::Vec3d(0.5 * kLeaf)) * h;
          // Twice the reach, since first-order distances are no bounds; what is missed all the same goes unnoticed.
          if (std::abs(tangle_distance(centre)) > 2 * reach) continue;
          fill(band, openvdb::Coord(i, j, k), openvdb::Coord(i, j, k).offsetBy(kLeaf), h);
        }
      }
    }
  }
  report(state, *grid);
}
BENCHMARK(openvdb_band_by_leaves)->RangeMultiplier(2)->Range(64, 512)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  openvdb::initialize();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
