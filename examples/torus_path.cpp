// The README's example: a shortest path on a torus.
#include <taut/query/path.hpp>
#include <taut/surface/formula.hpp>

#include <iostream>

int main() {
  const taut::Surface torus =
      taut::parse_surface("(x^2+y^2+z^2+R^2-r^2)^2 = 4R^2(x^2+y^2)", {.parameters = {{"R", 1}, {"r", 0.4}}});
  const taut::PathResult path = taut::shortest_path(torus, Eigen::Vector3d(1.4, 0, 0), Eigen::Vector3d(-1, 0, 0.4));
  std::cout << taut::to_string(path.status) << ", length " << path.length << " +- " << path.length_error << ", "
            << path.points.cols() << " points\n";
  return path.status == taut::Status::ok ? 0 : 1;
}
