// Paths over sampled heights, against the surface that was sampled.

#include <gtest/gtest.h>

#include <cmath>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/height_field.hpp"

namespace taut {
namespace {

double hill(double x, double y) { return 0.4 * std::exp(-2 * (x * x + y * y)); }

HeightField sampled(Index n) {
  HeightField field{.columns = n, .rows = n, .heights = {}, .x0 = -1, .y0 = -1};
  field.pixel_x = field.pixel_y = 2 / static_cast<double>(n - 1);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      field.heights.push_back(
          hill(-1 + static_cast<double>(i) * field.pixel_x, -1 + static_cast<double>(j) * field.pixel_y));
    }
  }
  return field;
}

TEST(HeightPaths, LengthsConvergeWithTheSplinesOrder) {
  const Eigen::Vector3d p(-0.7, -0.5, hill(-0.7, -0.5));
  const Eigen::Vector3d q(0.8, 0.3, hill(0.8, 0.3));
  const Surface exact = parse_surface("z = 0.4*exp(-2*(x^2+y^2))", {.domain = {"x^2 <= 1", "y^2 <= 1"}});
  const double length = shortest_path(exact, p, q, {.tolerance = 1e-12}).length;
  const auto error = [&](Index n) {
    const PathResult path = shortest_path(height_surface(sampled(n)), p, q);
    EXPECT_EQ(path.status, Status::ok) << path.message;
    return std::abs(path.length - length);
  };
  const double coarse = error(17);
  const double fine = error(33);
  EXPECT_LT(fine, 1e-5 * length);
  EXPECT_GT(std::log2(coarse / fine), 3.3);
}

}  // namespace
}  // namespace taut
