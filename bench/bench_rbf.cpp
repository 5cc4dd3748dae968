// Fitting and evaluating RBF surfaces. The opponents' figures, measured on one core with 1,000 samples and 3,000
// centres: SciPy's RBFInterpolator 4.6 s and 22 microseconds a value, ALGLIB 9.5 s and 120. Each run reports how far
// off the ellipsoid the zero set lies; the general solver of Eigen on the same matrix is the opponent in the run. And
// paths on a small one.

#include <benchmark/benchmark.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>

#include "support/clouds.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

const Eigen::Vector3d kAxes(1, 0.8, 0.6);

RbfModel fit(Index samples, bool both_sides) {
  Context context;
  context.threads = 1;
  return fit_rbf(test::ellipsoid_cloud(kAxes, samples), {.both_sides = both_sides, .max_samples = samples}, context);
}

double distance_from_truth(const Surface& surface) {
  const PointCloud truth = test::ellipsoid_cloud(kAxes, 1777);
  const Eigen::ArrayXXd value = surface.value(truth.points).array();
  const Eigen::ArrayXXd slope = surface.jacobian(truth.points).colwise().norm().array();
  return (value / slope).abs().maxCoeff();
}

void fit_surface(benchmark::State& state) {
  RbfModel model;
  for (auto _ : state) model = fit(state.range(0), state.range(1) != 0);
  state.counters["centres"] = static_cast<double>(model.centres.cols());
  state.counters["error"] = distance_from_truth(make_surface(std::make_shared<RbfModel>(model)));
}
BENCHMARK(fit_surface)->Args({1000, 0})->Args({1000, 1})->Args({2000, 0})->Unit(benchmark::kMillisecond);

void solve_by_eigen(benchmark::State& state) {
  const RbfModel model = fit(state.range(0), true);
  const Index n = model.centres.cols();
  for (auto _ : state) {
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 4, n + 4);
    for (Index j = 0; j < n; ++j) {
      system.col(j).head(n) = (model.centres.colwise() - model.centres.col(j)).colwise().norm().array().cube();
      system.col(j)(n) = system(j, n) = 1;
      system.col(j).tail(3) = model.centres.col(j);
      system.row(j).tail(3) = model.centres.col(j).transpose();
    }
    benchmark::DoNotOptimize(Vector(system.partialPivLu().solve(Vector::Ones(n + 4))));
  }
}
BENCHMARK(solve_by_eigen)->Arg(1000)->Unit(benchmark::kMillisecond);

/// state: samples, both sides; reports the time of one point.
void evaluate(benchmark::State& state) {
  const Surface surface = make_surface(std::make_shared<RbfModel>(fit(state.range(0), state.range(1) != 0)));
  const auto evaluator = surface.make_evaluator();
  constexpr Index n = 64;
  const Points x = test::ellipsoid_cloud(kAxes, n).points;
  Points value(1, n), jacobian(3, n), hessian(9, n);
  const Points weight = Points::Ones(1, n);
  for (auto _ : state) {
    evaluator->evaluate({.n = n,
                         .x = x.data(),
                         .value = value.data(),
                         .jacobian = jacobian.data(),
                         .weight = weight.data(),
                         .hessian = hessian.data()});
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * n);
}
/// The setting of the paper's table (290 to 311 cells; one source to several ends took 52 to 59 s), 300 centres.
/// Everything a path takes once the cells are there, 20 random pairs of samples in turn. Argument: -log10 tolerance.
void paths_in_the_papers_setting(benchmark::State& state) {
  constexpr Index kSamples = 150;
  const PointCloud cloud = test::ellipsoid_cloud(kAxes, kSamples);
  const Surface surface = make_surface(std::make_shared<RbfModel>(fit(kSamples, false)));
  PathSolver solver(surface, {.cell = 0.2, .tolerance = std::pow(10.0, -static_cast<double>(state.range(0)))},
                    {.threads = 1});
  Index pair = 0;
  const auto next = [&] {
    pair = (pair + 1) % 20;
    return solver.solve(cloud.points.col(7 * pair), cloud.points.col(149 - 3 * pair));
  };
  state.counters["cells"] = static_cast<double>(next().num_cells);
  for (auto _ : state) {
    if (next().status != Status::ok) state.SkipWithError("a path did not converge");
  }
}
BENCHMARK(paths_in_the_papers_setting)->Arg(6)->Arg(9)->Arg(12)->Unit(benchmark::kMillisecond);

BENCHMARK(evaluate)->Args({1000, 0})->Args({1000, 1})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace taut

BENCHMARK_MAIN();
