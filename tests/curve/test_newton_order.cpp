#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "curve/direct_system.hpp"
#include "curve/newton_kernel.hpp"
#include "support/geodesic_start.hpp"
#include "support/surfaces.hpp"

namespace taut {
namespace {

// Length of the discrete geodesic on m equal elements of degree p.
double discrete_length(const Surface& surface, const Points& path, int degree, Index elements) {
  detail::NewtonKernel<detail::DirectSystem<3, 1>> kernel(3, 1);
  const auto evaluator = surface.make_evaluator();
  const double length = 1.0;
  kernel.set_mesh(degree,
                  std::vector<double>(static_cast<std::size_t>(elements), length / static_cast<double>(elements)));
  const Index segments = path.cols() - 1;
  for (Index j = 0; j < kernel.num_nodes(); ++j) {
    const double xi = kernel.element().node(j % degree);
    const double t = (static_cast<double>(j / degree) + (xi + 1) / 2) / static_cast<double>(elements);
    const Index near = std::min<Index>(segments, std::lround(t * static_cast<double>(segments)));
    kernel.nodes().col(j) = path.col(j + 1 == kernel.num_nodes() ? segments : near);
  }
  const auto outcome =
      kernel.relax(*evaluator, {.energy = 1e-15, .off_surface = 1e-14, .max_iterations = 60, .minimum = true}, {});
  EXPECT_EQ(outcome, detail::Relaxation::converged);
  return kernel.length();
}

// The energy of a constrained curve of degree p, with F = 0 at Gauss-Lobatto nodes, converges like h^(2 p).
TEST(NewtonOrder, LengthConvergesWithTwiceTheDegree) {
  const Surface surface = test::torus(1, 0.4);
  const Vector p = Eigen::Vector3d(1.4, 0, 0);
  const Vector v = Eigen::Vector3d(0, 1, 1).normalized();
  const Points path = test::integrate_geodesic(surface, p, v, 1.2, 400);
  const double truth = discrete_length(surface, path, 12, 6);
  for (const int degree : {1, 2, 3, 4}) {
    const Index coarse = degree == 1 ? 16 : degree == 4 ? 2 : 4;
    const double first = std::abs(discrete_length(surface, path, degree, coarse) - truth);
    const double second = std::abs(discrete_length(surface, path, degree, 2 * coarse) - truth);
    const double third = std::abs(discrete_length(surface, path, degree, 4 * coarse) - truth);
    EXPECT_NEAR(std::log2(second / third), 2 * degree, 0.35)
        << "degree " << degree << ": " << first << " " << second << " " << third;
  }
}

// On one mesh the error falls geometrically with the degree.
TEST(NewtonOrder, LengthConvergesExponentiallyInTheDegree) {
  const Surface surface = test::ellipsoid(1, 1, 0.5);
  const Points path =
      test::integrate_geodesic(surface, Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 1).normalized(), 1.5, 400);
  const double truth = discrete_length(surface, path, 14, 4);
  double before = 1;
  for (const int degree : {2, 4, 6, 8}) {
    const double error = std::abs(discrete_length(surface, path, degree, 4) - truth);
    EXPECT_LT(error, std::max(0.02 * before, 4e-15)) << "degree " << degree;
    before = error;
  }
}

}  // namespace
}  // namespace taut
