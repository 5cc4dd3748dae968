// Time against accuracy, one thread: the shortest path between random points, the surface and its cells already there.
//
//   bench_path [--pairs FOLDER]
//
// Prints CSV: surface,method,setting,prepare_s,us,median_error,worst_error; times are medians a pair, errors relative.
// Taut: `path` is everything a pair takes, rivals included, by a table of distances (prepare_s: cells and table);
// `correction` is Newton's method alone, from the winning start. Opponent: GeographicLib on the ellipsoid of
// revolution. Truth: GeographicLib's exact geodesics there, Taut at 1e-13 elsewhere (which the reference tests check).
// With --pairs, writes the pairs and their true distances to FOLDER/SURFACE.csv for the opponents on meshes.

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicExact.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <random>
#include <string>
#include <vector>

#include "taut/curve/newton.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace {

using taut::Index;
using taut::PathResult;
using taut::Points;
using taut::Vector;
using Clock = std::chrono::steady_clock;

constexpr Index kPairs = 400;
constexpr double kPi = 3.14159265358979323846;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Problem {
  std::string name;
  taut::Surface surface;
  Points from, to;
  std::vector<double> truth;
};

Problem make_problem(const std::string& name, const std::string& formula, double reach) {
  Problem problem{name, taut::parse_surface(formula), Points(3, kPairs), Points(3, kPairs), {}};
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> inside(-reach, reach);
  for (Points* points : {&problem.from, &problem.to}) {
    for (Index j = 0; j < kPairs;) {
      const Vector x = Eigen::Vector3d(inside(random), inside(random), inside(random));
      const taut::ProjectionResult on = taut::project_to_surface(problem.surface, x);
      if (on.converged) points->col(j++) = on.point;
    }
  }
  return problem;
}

void print(const Problem& problem, const std::string& method, const std::string& setting, double prepare,
           const std::vector<double>& seconds, const std::vector<double>& lengths) {
  std::vector<double> errors;
  for (std::size_t j = 0; j < lengths.size(); ++j) errors.push_back(std::abs(lengths[j] / problem.truth[j] - 1));
  std::printf("%s,%s,%s,%.3g,%.4g,%.2g,%.2g\n", problem.name.c_str(), method.c_str(), setting.c_str(), prepare,
              1e6 * median(seconds), median(errors), *std::max_element(errors.begin(), errors.end()));
  std::fflush(stdout);
}

void run_taut(const Problem& problem, double tolerance) {
  const taut::Context one_thread{.threads = 1};
  const auto start = Clock::now();
  taut::PathSolver solver(problem.surface, {.tolerance = tolerance}, one_thread);
  Points near(3, 2 * kPairs);
  near << problem.from, problem.to;
  solver.expect(near, 100 * kPairs);
  const double prepare = seconds_since(start);
  taut::NewtonSolver newton(problem.surface, {.tolerance = tolerance});
  std::vector<double> path_seconds;
  std::vector<double> correction_seconds;
  std::vector<double> path_lengths;
  std::vector<double> correction_lengths;
  for (Index j = 0; j < kPairs; ++j) {
    const auto begin = Clock::now();
    const PathResult path = solver.solve(problem.from.col(j), problem.to.col(j));
    path_seconds.push_back(seconds_since(begin));
    path_lengths.push_back(path.length);
    const auto middle = Clock::now();
    const taut::NewtonResult corrected = newton.solve(path.grid_path, one_thread);
    correction_seconds.push_back(seconds_since(middle));
    correction_lengths.push_back(corrected.length);
  }
  char setting[16];
  std::snprintf(setting, sizeof setting, "%.0e", tolerance);
  print(problem, "taut path", setting, prepare, path_seconds, path_lengths);
  print(problem, "taut correction", setting, prepare, correction_seconds, correction_lengths);
}

/// Latitude and longitude on the ellipsoid x^2 + y^2 + z^2 / c^2 = 1, degrees.
struct Place {
  double latitude;
  double longitude;
};

Place place_of(const Vector& x, double c) {
  return {std::atan2(x(2), c * c * std::hypot(x(0), x(1))) * 180 / kPi, std::atan2(x(1), x(0)) * 180 / kPi};
}

template <class Geodesic>
std::vector<double> run_geographic(const Problem& problem, double c, std::vector<double>& seconds) {
  const Geodesic geodesic(1.0, 1 - c);
  std::vector<double> lengths;
  for (Index j = 0; j < kPairs; ++j) {
    const Place p = place_of(problem.from.col(j), c);
    const Place q = place_of(problem.to.col(j), c);
    double length = 0;
    const auto begin = Clock::now();
    geodesic.Inverse(p.latitude, p.longitude, q.latitude, q.longitude, length);
    seconds.push_back(seconds_since(begin));
    lengths.push_back(length);
  }
  return lengths;
}

void write_pairs(const Problem& problem, const std::string& folder) {
  std::ofstream file(folder + "/" + problem.name + ".csv");
  file << std::setprecision(17);
  for (Index j = 0; j < kPairs; ++j) {
    for (const Points* points : {&problem.from, &problem.to}) {
      for (Index i = 0; i < 3; ++i) file << (*points)(i, j) << ',';
    }
    file << problem.truth[static_cast<std::size_t>(j)] << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc == 3 && std::string(argv[1]) == "--pairs" ? argv[2] : "";
  constexpr double kHeight = 0.5;
  std::vector<Problem> problems;
  problems.push_back(make_problem("ellipsoid", "x^2+y^2+4z^2=1", 1.1));
  problems.push_back(make_problem("torus", "(x^2+y^2+z^2+1-0.16)^2=4*(x^2+y^2)", 1.5));
  problems.push_back(make_problem("tanglecube", "x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8=0", 2.2));
  std::printf("surface,method,setting,prepare_s,us,median_error,worst_error\n");
  for (Problem& problem : problems) {
    std::vector<double> seconds;
    if (problem.name == "ellipsoid") {
      problem.truth = run_geographic<GeographicLib::GeodesicExact>(problem, kHeight, seconds);
      print(problem, "GeographicLib exact", "", 0, seconds, problem.truth);
      seconds.clear();
      const std::vector<double> series = run_geographic<GeographicLib::Geodesic>(problem, kHeight, seconds);
      print(problem, "GeographicLib series", "", 0, seconds, series);
    } else {
      taut::PathSolver exact(problem.surface, {.tolerance = 1e-13});
      for (Index j = 0; j < kPairs; ++j) {
        problem.truth.push_back(exact.solve(problem.from.col(j), problem.to.col(j)).length);
      }
    }
    for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) run_taut(problem, tolerance);
    if (!folder.empty()) write_pairs(problem, folder);
  }
  return 0;
}
