#include "taut/query/surface_summary.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "taut/cells/find_cells.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

double total(const SurfaceEdges& found, SurfaceEdge::Kind kind) {
  double length = 0;
  for (const SurfaceEdge& edge : found.edges) length += edge.kind == kind ? edge.length : 0;
  return length;
}

struct MeshNumbers {
  double area = 0;
  double volume = 0;
  Index open = 0;   // sides that one triangle alone has
  Index twice = 0;  // sides that two triangles have in one direction
  Index euler = 0;
};

MeshNumbers numbers_of(const SurfaceMesh& mesh) {
  MeshNumbers result;
  std::map<std::pair<int, int>, int> sides;
  for (const auto& face : mesh.faces.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(face(0));
    const Eigen::Vector3d b = mesh.vertices.col(face(1));
    const Eigen::Vector3d c = mesh.vertices.col(face(2));
    result.area += (b - a).cross(c - a).norm() / 2;
    result.volume += a.dot(b.cross(c)) / 6;
    for (int i = 0; i < 3; ++i) ++sides[{face(i), face((i + 1) % 3)}];
  }
  for (const auto& [side, count] : sides) {
    result.twice += count > 1 ? 1 : 0;
    result.open += sides.contains({side.second, side.first}) ? 0 : 1;
  }
  result.euler = mesh.vertices.cols() - (3 * mesh.faces.cols() + result.open) / 2 + mesh.faces.cols();
  return result;
}

TEST(SurfaceEdges, CanHasTwoRims) {
  const SurfaceEdges can = surface_edges(parse_surface("max(x^2+y^2-4, abs(z)-1)"));
  ASSERT_EQ(can.edges.size(), 2U);
  for (const SurfaceEdge& rim : can.edges) {
    EXPECT_TRUE(rim.closed);
    EXPECT_NEAR(rim.length, 4 * pi, 1e-11);
    EXPECT_NEAR(rim.angle, pi / 2, 1e-12);
    EXPECT_EQ(rim.faces.size(), 2U);
    EXPECT_LT((rim.points.topRows(2).colwise().norm().array() - 2).abs().maxCoeff(), 1e-12);
  }
  EXPECT_EQ(can.faces.size(), 3U);
  EXPECT_EQ(can.corners.cols(), 0);
}

TEST(SurfaceEdges, BoxHasTwelveEdgesAndEightCorners) {
  const SurfaceEdges box = surface_edges(parse_surface("max(abs(x)-3,abs(y)-1.2,abs(z)-1.2)"));
  EXPECT_EQ(box.faces.size(), 6U);
  EXPECT_EQ(box.edges.size(), 12U);
  EXPECT_EQ(box.corners.cols(), 8);
  EXPECT_NEAR(total(box, SurfaceEdge::Kind::sharp), 4 * (6 + 2.4 + 2.4), 1e-11);
}

TEST(SurfaceEdges, CrossedCylindersMeetInPointsToo) {
  const SurfaceEdges shape = surface_edges(parse_surface("max(x^2+y^2,x^2+z^2,y^2+z^2)-2"));
  EXPECT_EQ(shape.edges.size(), 24U);
  EXPECT_EQ(shape.corners.cols(), 8 + 6);  // cube's corners, and where the faces touch on the axes
  Index patches = 0;
  for (const SurfaceFace& face : shape.faces) patches += face.patches;
  EXPECT_EQ(patches, 12);
}

TEST(SurfaceEdges, SeamsAreNoSharpEdges) {
  const SurfaceEdges rounded =
      surface_edges(parse_surface("sqrt(max(abs(x)-2,0)^2+max(abs(y)-1,0)^2+max(abs(z)-1,0)^2)=0.5"));
  EXPECT_EQ(rounded.edges.size(), 48U);  // 24 straight ones, 24 quarter circles
  EXPECT_NEAR(total(rounded, SurfaceEdge::Kind::seam), 2 * 4 * (4 + 2 + 2) + 24 * 0.5 * pi / 2, 1e-10);
}

TEST(SurfaceEdges, BordersAreFollowed) {
  const Surface plane = parse_surface("z=0", {.dim = 3, .domain = {"x^2+y^2>=1", "abs(x)<=4", "abs(y)<=4"}});
  const SurfaceEdges found = surface_edges(plane);
  EXPECT_EQ(found.edges.size(), 5U);  // the kinks of abs end none
  EXPECT_EQ(found.corners.cols(), 4);
  EXPECT_NEAR(total(found, SurfaceEdge::Kind::border), 2 * pi + 32, 1e-10);
}

TEST(SurfaceEdges, SmoothSurfacesHaveNone) { EXPECT_TRUE(surface_edges(parse_surface("x^2+y^2+z^2=1")).edges.empty()); }

TEST(SharpMesh, BoxIsExact) {
  const MeshNumbers box = numbers_of(display_mesh(parse_surface("max(abs(x)-1.51,abs(y)-0.62,abs(z)-0.63)")));
  EXPECT_NEAR(box.volume, 8 * 1.51 * 0.62 * 0.63, 1e-10);
  EXPECT_NEAR(box.area, 8 * (1.51 * 0.62 + 1.51 * 0.63 + 0.62 * 0.63), 1e-10);
  EXPECT_EQ(box.open, 0);
  EXPECT_EQ(box.twice, 0);
  EXPECT_EQ(box.euler, 2);
}

TEST(SharpMesh, AreaIsOfSecondOrderInTheCells) {
  const Surface lens = parse_surface("max(x^2+y^2+z^2-1, 0.5-z)");
  const double area = pi + 0.75 * pi;  // a cap of height 1/2, and its floor
  const double coarse = area - numbers_of(display_mesh(lens, {.cell = 0.1})).area;
  const double fine = area - numbers_of(display_mesh(lens, {.cell = 0.05})).area;
  EXPECT_LT(std::abs(coarse), 0.05);
  EXPECT_LT(std::abs(fine), 0.35 * std::abs(coarse));
}

TEST(SharpMesh, PartedFacesHaveTheirOwnNormals) {
  const SurfaceMesh mesh = display_mesh(parse_surface("max(x^2+y^2-4, abs(z)-1)"), {.cell = 0.2, .part_faces = true});
  EXPECT_EQ(mesh.edges.lines.size(), 2U);
  for (Index v = 0; v < mesh.vertices.cols(); ++v) {
    const Eigen::Vector3d n = mesh.normals.col(v);
    EXPECT_LT(std::min(std::abs(std::abs(n.z()) - 1), std::abs(n.z())), 1e-9) << v;
  }
}

TEST(SurfaceSummary, CountsEdges) {
  const SurfaceSummary can = summarise(parse_surface("max(x^2+y^2-4, abs(z)-1)"));
  ASSERT_TRUE(can.edges);
  EXPECT_EQ(can.edges->edges.size(), 2U);
  EXPECT_EQ(can.shape->euler, 2);
  EXPECT_TRUE(can.shape->closed);
  EXPECT_FALSE(summarise(parse_surface("x^2+y^2+z^2=1")).edges);
}

}  // namespace
}  // namespace taut
