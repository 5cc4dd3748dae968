// A surface given by parameters, x(u, v): sampled with its normals, made into an implicit surface, and asked for a
// path. Prints the length beside that of the same torus given by its equation.

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include "taut/query/path.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/formula.hpp"

using Eigen::Vector3d;

// A torus: u goes round the axis, v round the tube.
Vector3d point(double u, double v) {
  const double r = 1 + 0.4 * std::cos(v);
  return {r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)};
}
// x_u cross x_v, made a unit vector; central differences would do where no formula is at hand.
Vector3d normal(double u, double v) { return {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)}; }

int main() {
  constexpr int kRound = 60;  // samples round the axis, and half as many round the tube
  taut::PointCloud cloud;
  cloud.points.resize(3, kRound * kRound / 2);
  cloud.normals.resize(3, kRound * kRound / 2);
  for (int i = 0; i < kRound; ++i) {
    for (int j = 0; j < kRound / 2; ++j) {
      const double u = 2 * std::numbers::pi * i / kRound;
      const double v = 4 * std::numbers::pi * j / kRound;
      cloud.points.col(i * kRound / 2 + j) = point(u, v);
      cloud.normals.col(i * kRound / 2 + j) = normal(u, v);
    }
  }
  // The samples are exact, and the surface is closed: no smoothing, no end.
  const auto model =
      std::make_shared<const taut::RbfModel>(taut::fit_rbf(cloud, {.smoothing = 0, .support_radius = -1}));
  const taut::Surface sampled = taut::make_surface(model);
  const taut::Surface equation = taut::parse_surface("(sqrt(x^2+y^2)-1)^2+z^2=0.16");

  const Vector3d from = point(0.2, 0.5);
  const Vector3d to = point(2.4, 2.3);
  const double length = taut::shortest_path(sampled, from, to).length;
  const double truth = taut::shortest_path(equation, from, to).length;
  std::cout << "sampled " << length << ", by its equation " << truth << ", difference " << length - truth << "\n";
  return std::abs(length - truth) < 1e-3 * truth ? 0 : 1;
}
