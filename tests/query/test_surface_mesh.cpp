#include "taut/query/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut {
namespace {

TEST(DisplayMesh, VerticesLieOnTheSurface) {
  const SurfaceMesh mesh = display_mesh(parse_surface("x^2+y^2+z^2=1"));
  EXPECT_GT(mesh.faces.cols(), 100);
  EXPECT_LT((mesh.vertices.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
}

TEST(DisplayMesh, RoughVerticesAreWithinAHundredthOfACell) {
  const Surface sphere = parse_surface("x^2+y^2+z^2=1");
  const SurfaceMesh mesh = display_mesh(sphere, {.cell = 0.1, .exact = false});
  EXPECT_LT((mesh.vertices.colwise().norm().array() - 1).abs().maxCoeff(), 1e-3);
}

TEST(DisplayMesh, IsNoCoarserThanAskedFor) {
  const Surface sphere = parse_surface("x^2+y^2+z^2=1");
  const Index chosen = display_mesh(sphere).faces.cols();
  EXPECT_EQ(display_mesh(sphere, {.cell_at_most = 10}).faces.cols(), chosen);
  EXPECT_GT(display_mesh(sphere, {.cell_at_most = 0.01}).faces.cols(), 2 * chosen);
}

TEST(DisplayMesh, OfManySamplesStaysWithinItsBudget) {
  PointCloud cloud;
  const Index n = 30'000;
  cloud.points.resize(3, n);
  for (Index i = 0; i < n; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n);
    const double a = static_cast<double>(i) * std::numbers::phi * 2 * std::numbers::pi;
    cloud.points.col(i) << std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z;
  }
  const Surface ball = parse_surface("x^2+y^2+z^2=1").with_samples(std::make_shared<const PointCloud>(cloud));
  const SurfaceMesh mesh = display_mesh(ball);
  EXPECT_GT(mesh.vertices.cols(), 5'000);
  EXPECT_LT(mesh.vertices.cols(), 30'000);                     // about one a cell
  EXPECT_EQ(mesh.vertices.cols() - mesh.faces.cols() / 2, 2);  // closed: Euler's V - F/2 = 2
}

TEST(DisplayMesh, OfASurfaceWithoutEndShowsThePlacesAskedFor) {
  Points near(3, 2);
  near << 100, 103, 50, 52, 0, 0;
  const SurfaceMesh mesh = display_mesh(parse_surface("z=0.1*sin(x)"), {.near = near});
  const Eigen::Vector3d low = mesh.vertices.rowwise().minCoeff();
  const Eigen::Vector3d high = mesh.vertices.rowwise().maxCoeff();
  EXPECT_LT(low.x(), 100);
  EXPECT_LT(low.y(), 50);
  EXPECT_GT(high.x(), 103);
  EXPECT_GT(high.y(), 52);
}

TEST(DisplayCurve, IsTheCircle) {
  const CurveMesh circle = display_curve(parse_surface("x^2+y^2=1"));
  EXPECT_EQ(circle.segments.cols(), circle.vertices.cols());  // closed
  EXPECT_LT((circle.vertices.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
  double length = 0;
  for (const auto& s : circle.segments.colwise())
    length += (circle.vertices.col(s(0)) - circle.vertices.col(s(1))).norm();
  EXPECT_NEAR(length, 2 * std::numbers::pi, 1e-2);
  EXPECT_THROW((void)display_curve(parse_surface("x^2+y^2+z^2=1")), InvalidArgument);
}

TEST(DisplayMesh, OnlyInSpace) { EXPECT_THROW((void)display_mesh(parse_surface("x^2+y^2=1")), InvalidArgument); }

}  // namespace
}  // namespace taut
