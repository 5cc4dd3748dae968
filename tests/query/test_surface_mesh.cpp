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

// Two spheres, and a cube with sharp edges between them: areas 4 pi, 6 x 0.36, 4 pi 0.04.
TEST(DisplayMesh, OneComponentOfSeveral) {
  const Surface three =
      parse_surface("min(x^2+y^2+z^2-1, min((x-4)^2+y^2+z^2-0.04, max(abs(x-2), max(abs(y), abs(z)))-0.3))");
  const auto area = [](const SurfaceMesh& mesh) {
    double sum = 0;
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
      const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, f));
      const Eigen::Vector3d b = mesh.vertices.col(mesh.faces(1, f));
      const Eigen::Vector3d c = mesh.vertices.col(mesh.faces(2, f));
      sum += (b - a).cross(c - a).norm() / 2;
    }
    return sum;
  };
  for (const bool part_faces : {false, true}) {
    const auto piece = [&](int which) {
      return display_mesh(three, {.cell = 0.05, .part_faces = part_faces, .component = which});
    };
    const SurfaceMesh all = piece(0);
    const SurfaceMesh ball = piece(1);
    const SurfaceMesh cube = piece(2);
    const SurfaceMesh bead = piece(3);
    EXPECT_NEAR(area(ball), 4 * std::numbers::pi, 0.02);
    EXPECT_NEAR(area(cube), 2.16, 1e-9);
    EXPECT_NEAR(area(bead), 0.16 * std::numbers::pi, 0.01);
    EXPECT_EQ(ball.faces.cols() + cube.faces.cols() + bead.faces.cols(), all.faces.cols());
    EXPECT_EQ(ball.vertices.cols() + cube.vertices.cols() + bead.vertices.cols(), all.vertices.cols());
    EXPECT_LT((ball.vertices.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
    EXPECT_EQ(cube.normals.cols(), cube.vertices.cols());
    EXPECT_EQ(cube.cell.size(), static_cast<std::size_t>(cube.vertices.cols()));
    EXPECT_EQ(cube.edges.lines.size(), 12U);
    EXPECT_TRUE(ball.edges.lines.empty());
    EXPECT_THROW((void)piece(4), InvalidArgument);
  }
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
