#include "taut/query/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(DisplayMesh, VerticesLieOnTheSurface) {
  const SurfaceMesh mesh = display_mesh(parse_surface("x^2+y^2+z^2=1"));
  EXPECT_GT(mesh.faces.cols(), 100);
  EXPECT_LT((mesh.vertices.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
}

TEST(DisplayCells, LieAroundTheSurfaceAndCoverIt) {
  const double h = 0.1;
  for (const int dim : {2, 3}) {
    const Surface sphere = parse_surface(dim == 2 ? "x^2+y^2=1" : "x^2+y^2+z^2=1");
    const Points centres = display_cells(sphere, {.cell = h});
    ASSERT_EQ(centres.rows(), dim);
    EXPECT_LT((centres.colwise().norm().array() - 1).abs().maxCoeff(), h * std::sqrt(dim) / 2 + 1e-12);
    // Every surface point lies in one of them.
    for (int i = 0; i < 400; ++i) {
      const double height = dim == 2 ? 0 : 1 - (i + 0.5) / 200;
      const double angle = i * std::numbers::phi * 2 * std::numbers::pi;
      const double radius = std::sqrt(1 - height * height);
      Vector x(dim);
      x.head<2>() << radius * std::cos(angle), radius * std::sin(angle);
      if (dim == 3) x(2) = height;
      EXPECT_LE((centres.colwise() - x).cwiseAbs().colwise().maxCoeff().minCoeff(), h / 2 + 1e-12);
    }
  }
}

TEST(DisplayMesh, OnlyInSpace) { EXPECT_THROW((void)display_mesh(parse_surface("x^2+y^2=1")), InvalidArgument); }

}  // namespace
}  // namespace taut
