// A quarter of a great circle through the installed library.
#include <taut/taut.hpp>

#include <cmath>
#include <cstdio>

int main() {
  const taut::Surface sphere = taut::parse_surface("x^2 + y^2 + z^2 = 1");
  const taut::PathResult path = taut::shortest_path(sphere, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY());
  std::printf("%.15g\n", path.length);
  return path.status == taut::Status::ok && std::abs(path.length - std::acos(0.0)) < 1e-9 ? 0 : 1;
}
