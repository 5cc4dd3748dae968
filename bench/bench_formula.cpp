// Formulas against C++ functions written by hand for the same surface, in nanoseconds a point. The hand-written ones
// are what a user would write: one point at a time, scalar, all common parts shared. Both fill the same arrays.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "taut/surface/formula.hpp"

namespace {

using taut::Index;
using taut::Points;

// Each writes F, its gradient (3) and its Hessian (9); null outputs are skipped.

struct Sphere {
  static std::string formula() { return "x^2+y^2+z^2 = 1"; }
  static void evaluate(const double* x, double* f, double* g, double* h) {
    if (f != nullptr) *f = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1;
    if (g != nullptr) {
      for (int i = 0; i < 3; ++i) g[i] = 2 * x[i];
    }
    if (h != nullptr) {
      for (int i = 0; i < 9; ++i) h[i] = i % 4 == 0 ? 2 : 0;
    }
  }
};

struct Torus {
  static std::string formula() { return "(x^2+y^2+z^2 + 0.84)^2 - 4*(x^2+y^2)"; }
  static void evaluate(const double* x, double* f, double* g, double* h) {
    const double q = x[0] * x[0] + x[1] * x[1];
    const double s = q + x[2] * x[2] + 0.84;
    if (f != nullptr) *f = s * s - 4 * q;
    if (g != nullptr) {
      const double a = 4 * s - 8;
      g[0] = a * x[0];
      g[1] = a * x[1];
      g[2] = 4 * s * x[2];
    }
    if (h != nullptr) {
      const double a = 4 * s - 8;
      h[0] = 8 * x[0] * x[0] + a;
      h[4] = 8 * x[1] * x[1] + a;
      h[8] = 8 * x[2] * x[2] + 4 * s;
      h[1] = h[3] = 8 * x[0] * x[1];
      h[2] = h[6] = 8 * x[0] * x[2];
      h[5] = h[7] = 8 * x[1] * x[2];
    }
  }
};

struct TangleCube {
  static std::string formula() { return "x^4-5x^2 + y^4-5y^2 + z^4-5z^2 + 11.8"; }
  static void evaluate(const double* x, double* f, double* g, double* h) {
    double sum = 11.8;
    for (int i = 0; i < 3; ++i) {
      const double q = x[i] * x[i];
      sum += q * (q - 5);
      if (g != nullptr) g[i] = x[i] * (4 * q - 10);
      if (h != nullptr) h[4 * i] = 12 * q - 10;
    }
    if (f != nullptr) *f = sum;
    if (h != nullptr) h[1] = h[2] = h[3] = h[5] = h[6] = h[7] = 0;
  }
};

struct Gyroid {
  static std::string formula() { return "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)"; }
  static void evaluate(const double* x, double* f, double* g, double* h) {
    const double sx = std::sin(x[0]), sy = std::sin(x[1]), sz = std::sin(x[2]);
    const double cx = std::cos(x[0]), cy = std::cos(x[1]), cz = std::cos(x[2]);
    if (f != nullptr) *f = sx * cy + sy * cz + sz * cx;
    if (g != nullptr) {
      g[0] = cx * cy - sz * sx;
      g[1] = cy * cz - sx * sy;
      g[2] = cz * cx - sy * sz;
    }
    if (h != nullptr) {
      h[0] = -sx * cy - sz * cx;
      h[4] = -sy * cz - sx * cy;
      h[8] = -sz * cx - sy * cz;
      h[1] = h[3] = -cx * sy;
      h[2] = h[6] = -cz * sx;
      h[5] = h[7] = -cy * sz;
    }
  }
};

/// 64 soft balls blended into one body: 700 operations, 64 of them exponentials.
struct Blobs {
  static constexpr int kBalls = 64;

  struct Ball {
    double centre[3];
    double sharpness;
  };

  static const std::vector<Ball>& balls() {
    static const std::vector<Ball> all = [] {
      std::mt19937 random(7);
      std::uniform_real_distribution<double> place(-1, 1), sharpness(2, 8);
      std::vector<Ball> made(kBalls);
      for (Ball& ball : made) ball = {{place(random), place(random), place(random)}, sharpness(random)};
      return made;
    }();
    return all;
  }

  static std::string formula() {
    std::ostringstream text;
    text.precision(17);
    for (const Ball& ball : balls()) {
      const auto& [x, y, z] = ball.centre;
      text << "+exp(-" << ball.sharpness << "*((x-(" << x << "))^2+(y-(" << y << "))^2+(z-(" << z << "))^2))";
    }
    return text.str() + "=1";
  }

  static void evaluate(const double* x, double* f, double* g, double* h) {
    double sum = -1;
    double slope[3] = {};
    double bend[9] = {};
    for (const Ball& ball : balls()) {
      const double u[3] = {x[0] - ball.centre[0], x[1] - ball.centre[1], x[2] - ball.centre[2]};
      const double a = 2 * ball.sharpness;
      const double e = std::exp(-ball.sharpness * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
      sum += e;
      if (g == nullptr) continue;
      const double b = -a * e;
      for (int i = 0; i < 3; ++i) slope[i] += b * u[i];
      if (h == nullptr) continue;
      const double c = a * a * e;
      bend[0] += c * u[0] * u[0] + b;
      bend[4] += c * u[1] * u[1] + b;
      bend[8] += c * u[2] * u[2] + b;
      bend[1] += c * u[0] * u[1];
      bend[2] += c * u[0] * u[2];
      bend[5] += c * u[1] * u[2];
    }
    if (f != nullptr) *f = sum;
    if (g != nullptr) std::copy_n(slope, 3, g);
    if (h == nullptr) return;
    bend[3] = bend[1];
    bend[6] = bend[2];
    bend[7] = bend[5];
    std::copy_n(bend, 9, h);
  }
};

enum Wanted { kValue, kGradient, kHessian };

Points sample_points(Index n) {
  std::srand(1);
  return Points::Random(3, n) * 1.5;
}

void set_rate(benchmark::State& state, Index n) {
  state.counters["per_point"] = benchmark::Counter(
      static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Surface, Wanted wanted>
void by_hand(benchmark::State& state) {
  const Index n = state.range(0);
  const Points x = sample_points(n);
  Points f(1, n), g(3, n), h(9, n);
  for (auto _ : state) {
    for (Index j = 0; j < n; ++j) {
      Surface::evaluate(x.data() + 3 * j, f.data() + j, wanted >= kGradient ? g.data() + 3 * j : nullptr,
                        wanted >= kHessian ? h.data() + 9 * j : nullptr);
    }
    benchmark::DoNotOptimize(f.data());
    benchmark::DoNotOptimize(g.data());
    benchmark::DoNotOptimize(h.data());
    benchmark::ClobberMemory();
  }
  set_rate(state, n);
}

template <class Surface, Wanted wanted>
void by_formula(benchmark::State& state) {
  const Index n = state.range(0);
  const Points x = sample_points(n);
  const Points weight = Points::Ones(1, n);
  Points f(1, n), g(3, n), h(9, n);
  const auto evaluator = taut::parse_surface(Surface::formula()).make_evaluator();
  for (auto _ : state) {
    evaluator->evaluate({.n = n,
                         .x = x.data(),
                         .value = f.data(),
                         .jacobian = wanted >= kGradient ? g.data() : nullptr,
                         .weight = wanted >= kHessian ? weight.data() : nullptr,
                         .hessian = wanted >= kHessian ? h.data() : nullptr});
    benchmark::ClobberMemory();
  }
  set_rate(state, n);
}

template <class Surface>
void bounds(benchmark::State& state) {
  const Index n = state.range(0);
  const Points lower = sample_points(n);
  const Points upper = lower.array() + 0.01;
  Points low(1, n), high(1, n);
  const auto evaluator = taut::parse_surface(Surface::formula()).make_evaluator();
  for (auto _ : state) {
    evaluator->bounds(
        {.n = n, .lower = lower.data(), .upper = upper.data(), .value_lower = low.data(), .value_upper = high.data()});
    benchmark::ClobberMemory();
  }
  set_rate(state, n);
}

/// Bounds of the Jacobian; skipped where those of the value are exact.
template <class Surface>
void slope_bounds(benchmark::State& state) {
  const Index n = state.range(0);
  const Points lower = sample_points(n);
  const Points upper = lower.array() + 0.01;
  Points low(3, n), high(3, n);
  const auto evaluator = taut::parse_surface(Surface::formula()).make_evaluator();
  for (auto _ : state) {
    if (!evaluator->jacobian_bounds({.n = n,
                                     .lower = lower.data(),
                                     .upper = upper.data(),
                                     .jacobian_lower = low.data(),
                                     .jacobian_upper = high.data()})) {
      state.SkipWithError("not needed");
      break;
    }
    benchmark::ClobberMemory();
  }
  set_rate(state, n);
}

/// From text to a compiled Jacobian and Hessian.
template <class Surface>
void parse_and_compile(benchmark::State& state) {
  const Points x = sample_points(1);
  const double weight = 1;
  Points h(9, 1);
  for (auto _ : state) {
    taut::parse_surface(Surface::formula())
        .make_evaluator()
        ->evaluate({.n = 1, .x = x.data(), .weight = &weight, .hessian = h.data()});
  }
}

template <class Surface>
void register_surface(const std::string& name) {
  const auto add = [&](const char* what, auto* function) {
    benchmark::RegisterBenchmark((name + "/" + what).c_str(), function)->Arg(1)->Arg(64)->Arg(1024);
  };
  add("value/hand", by_hand<Surface, kValue>);
  add("value/formula", by_formula<Surface, kValue>);
  add("gradient/hand", by_hand<Surface, kGradient>);
  add("gradient/formula", by_formula<Surface, kGradient>);
  add("hessian/hand", by_hand<Surface, kHessian>);
  add("hessian/formula", by_formula<Surface, kHessian>);
  add("bounds/formula", bounds<Surface>);
  add("slope_bounds/formula", slope_bounds<Surface>);
  benchmark::RegisterBenchmark((name + "/compile").c_str(), parse_and_compile<Surface>);
}

}  // namespace

int main(int argc, char** argv) {
  register_surface<Sphere>("sphere");
  register_surface<Torus>("torus");
  register_surface<TangleCube>("tangle_cube");
  register_surface<Gyroid>("gyroid");
  register_surface<Blobs>("blobs");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
