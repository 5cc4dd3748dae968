#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/march/march.hpp"

namespace taut::test {

/// All cells of the component that `seed` lies on.
inline SurfaceCells all_cells(const Surface& surface, const Vector& seed, double size) {
  SurfaceCells cells = SurfaceCells::lazy(surface, seed, size);
  for (Index i = 0; i < cells.num_cells(); ++i) cells.expand(i);
  return cells;
}

inline Vector random_unit(Index d, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector x(d);
  for (Index i = 0; i < d; ++i) x(i) = normal(random);
  return x.normalized();
}

/// Distance on the unit sphere, exact for near and for opposite points.
inline double sphere_distance(const Vector& p, const Vector& q) {
  return 2 * std::atan2((p - q).norm(), (p + q).norm());
}

struct Errors {
  double mean = 0;  ///< mean relative error
  double max = 0;
  Index count = 0;

  void add(double value, double truth) {
    if (truth == 0) return;
    const double error = std::abs(value / truth - 1);
    mean = (mean * static_cast<double>(count) + error) / static_cast<double>(count + 1);
    max = std::max(max, error);
    ++count;
  }
};

/// Errors of the distances at all reached cells of the unit sphere.
inline Errors sphere_errors(const SurfaceCells& cells, const DistanceField& field, const Vector& source) {
  Errors errors;
  for (Index i = 0; i < field.distance.size(); ++i) {
    if (std::isfinite(field.distance(i))) errors.add(field.distance(i), sphere_distance(source, cells.point(i)));
  }
  return errors;
}

/// Slope of log(error) against log(h).
inline double order(const std::vector<std::pair<double, double>>& h_and_error) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [h, error] : h_and_error) {
    const double x = std::log(h), y = std::log(error);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

struct DistanceRow {
  Vector p, q;
  double distance = 0;
};

/// Lines p, q, d of a file in tests/data; '#' starts a comment.
inline std::vector<DistanceRow> read_distances(const std::string& name, Index d) {
  std::ifstream file(std::string(TAUT_TEST_DATA) + "/" + name);
  EXPECT_TRUE(file.good()) << name;
  std::vector<DistanceRow> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream numbers(line);
    DistanceRow row{Vector(d), Vector(d)};
    char comma = 0;
    for (Index i = 0; i < d; ++i) numbers >> row.p(i) >> comma;
    for (Index i = 0; i < d; ++i) numbers >> row.q(i) >> comma;
    numbers >> row.distance;
    EXPECT_FALSE(numbers.fail()) << line;
    rows.push_back(row);
  }
  return rows;
}

inline double polyline_length(const Points& x) {
  double length = 0;
  for (Index j = 1; j < x.cols(); ++j) length += (x.col(j) - x.col(j - 1)).norm();
  return length;
}

}  // namespace taut::test
