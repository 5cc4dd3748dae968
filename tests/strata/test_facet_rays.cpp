// Rays over edges: unfolded faces, and paths walked again from their start.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/query/tangent_maps.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using Eigen::Vector3d;

Surface surface_of(const std::string& formula, const std::vector<std::string>& domain = {}) {
  FormulaOptions options;
  options.dim = 3;
  options.domain = domain;
  return parse_surface(formula, options);
}

TEST(FacetRays, OverTheRimOfACan) {
  RaySolver solver(surface_of("max(x^2+y^2-4, abs(z)-1)"));
  const RayResult ray = solver.solve(Vector3d(0.5, 0, 1), Vector3d(1, 0, 0), 2.5);
  EXPECT_EQ(ray.status, Status::ok) << ray.message;
  EXPECT_LE((ray.point - Vector3d(2, 0, 0)).norm(), 1e-13);
  EXPECT_LE((ray.direction - Vector3d(0, 0, -1)).norm(), 1e-13);
  ASSERT_EQ(ray.pieces.size(), 3U);
  EXPECT_NEAR(ray.pieces[0].length, 1.5, 1e-13);
  EXPECT_EQ(ray.pieces[1].kind, PathPiece::Kind::crossing);
  EXPECT_NEAR(ray.pieces[1].left, std::acos(-1) / 2, 1e-9);
  // And back, by a negative length.
  const RayResult back = solver.solve(ray.point, ray.direction, -2.5);
  EXPECT_EQ(back.status, Status::ok) << back.message;
  EXPECT_LE((back.point - Vector3d(0.5, 0, 1)).norm(), 1e-13);
  EXPECT_LE((back.direction - Vector3d(1, 0, 0)).norm(), 1e-13);
}

// What a path's start direction and length lead to is its end; at a crossing the path and the ray obey the same law,
// but each is computed in its own way.
TEST(FacetRays, WalkPathsAgain) {
  struct Case {
    const char* formula;
    Vector3d p;
    Vector3d q;
  };
  const std::vector<Case> cases = {
      {"max(x^2+y^2-4, abs(z)-1)", {0.5, 0, 1}, {2 * std::cos(1.1), 2 * std::sin(1.1), 0.3}},
      {"max(abs(x)-15,abs(y)-6,abs(z)-6)", {-15, 0.3, 5}, {15, 0.1, -5}},
      {"max(sqrt(x^2+y^2)+z-1, -z)", {0.3, 0, 0}, {0.6 * std::cos(0.8), 0.6 * std::sin(0.8), 0.4}},
      {"max(x^2+z^2,y^2+z^2)=1", {std::sin(0.9), 0.3, std::cos(0.9)}, {0.5, std::sin(0.8), std::cos(0.8)}},
      {"sqrt(max(abs(x)-0.8,0)^2+max(abs(y)-0.5,0)^2+max(abs(z)-0.3,0)^2)=0.2", {1, 0.2, 0.1}, {-0.3, 0.1, -0.5}},
  };
  for (const Case& one : cases) {
    const Surface surface = surface_of(one.formula);
    const PathResult path = shortest_path(surface, one.p, one.q);
    ASSERT_EQ(path.status, Status::ok) << one.formula << path.message;
    const RayResult ray = RaySolver(surface).solve(one.p, path.start_direction, path.length);
    EXPECT_EQ(ray.status, Status::ok) << one.formula << ray.message;
    EXPECT_LE((ray.point - path.to).norm(), 1e-7) << one.formula;  // the direction is known to the root of rounding
    EXPECT_EQ(ray.pieces.size(), path.pieces.size()) << one.formula;
  }
}

TEST(FacetRays, EndsAreToldWhere) {
  RaySolver cube(surface_of("max(abs(x),abs(y),abs(z))-1"));
  const RayResult corner = cube.solve(Vector3d(0, 0, 1), Vector3d(1, 1, 0), 3);
  EXPECT_EQ(corner.status, Status::not_converged);
  EXPECT_NEAR(corner.length, std::sqrt(2.0), 1e-12);
  EXPECT_NE(corner.message.find("corner"), std::string::npos);
  // Round a cube at a slope and home again.
  const RayResult round = cube.solve(Vector3d(0.1, 0, 1), Vector3d(1, 0, 0), 8);
  EXPECT_EQ(round.status, Status::ok) << round.message;
  EXPECT_LE((round.point - Vector3d(0.1, 0, 1)).norm(), 1e-13);
  EXPECT_EQ(round.pieces.size(), 9U);
  RaySolver cut(surface_of("z=abs(x)", {"y<=1"}));
  const RayResult border = cut.solve(Vector3d(-1, 0, 1), Vector3d(1, 0.5, -1), 9);
  EXPECT_EQ(border.status, Status::left_domain);
  EXPECT_NEAR(border.point(1), 1, 1e-13);
  EXPECT_NEAR(border.point(0), -1 + 2, 1e-12);
}

TEST(FacetRays, ManyAreThoseAlone) {
  RaySolver solver(surface_of("max(x^2+y^2-4, abs(z)-1)"));
  Points from(3, 40);
  Points way(3, 40);
  for (Index j = 0; j < 40; ++j) {
    from.col(j) << 0.02 * static_cast<double>(j), 0.1, 1;
    way.col(j) << std::cos(static_cast<double>(j)), std::sin(static_cast<double>(j)), 0;
  }
  const std::vector<RayResult> many = solver.solve_many(from, way, Vector::Constant(40, 5));
  for (Index j = 0; j < 40; ++j) {
    const RayResult alone = solver.solve(from.col(j), way.col(j), 5);
    EXPECT_EQ(alone.status, Status::ok) << alone.message;
    EXPECT_EQ(many[static_cast<std::size_t>(j)].point, alone.point);
    EXPECT_EQ(many[static_cast<std::size_t>(j)].length, 5);
  }
}

}  // namespace
}  // namespace taut
