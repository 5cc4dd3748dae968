#include "taut/query/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

Vector axis(Index d, Index i) { return Vector::Unit(d, i); }

Vector random_unit(Index d, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector x(d);
  for (double& c : x) c = normal(random);
  return x.normalized();
}

TEST(ShortestPath, QuarterOfAGreatCircleInSeveralDimensions) {
  for (const Index d : {2, 3, 4, 6, 10, 50}) {
    const PathResult path = shortest_path(test::unit_sphere(d), axis(d, 0), axis(d, 1));
    ASSERT_EQ(path.status, Status::ok) << "d = " << d << ": " << path.message;
    EXPECT_NEAR(path.length, pi / 2, 1e-9) << "d = " << d;
    EXPECT_LE(std::abs(path.length - pi / 2), path.length_error + 1e-15) << "d = " << d;
    EXPECT_TRUE(path.locally_shortest) << "d = " << d;
  }
}

TEST(ShortestPath, RunsFromStartToEndExactlyAndNotBackwards) {
  const Vector p = Eigen::Vector3d(1.4, 0, 0);
  const Vector q = Eigen::Vector3d(0, -1, 0.4);
  const PathResult path = shortest_path(test::torus(), p, q);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_EQ(path.points.col(0), path.from);
  EXPECT_EQ(path.points.rightCols(1), path.to);
  EXPECT_LT((path.from - p).norm(), 1e-14);
  EXPECT_LT((path.to - q).norm(), 1e-14);
  // Steps go forward: consecutive ones never turn back.
  for (Index i = 2; i < path.points.cols(); ++i) {
    const Vector a = path.points.col(i - 1) - path.points.col(i - 2);
    const Vector b = path.points.col(i) - path.points.col(i - 1);
    EXPECT_GT(a.dot(b), 0) << "at point " << i;
  }
}

TEST(ShortestPath, IsSymmetricAndAboveTheChordOnRandomPairs) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random(kSeed);
  PathSolver solver(test::ellipsoid(1, 0.8, 0.5));
  const Eigen::Vector3d a(1, 0.8, 0.5);
  for (int trial = 0; trial < 10; ++trial) {
    const Vector p = random_unit(3, random).cwiseProduct(a);
    const Vector q = random_unit(3, random).cwiseProduct(a);
    const PathResult there = solver.solve(p, q);
    const PathResult back = solver.solve(q, p);
    ASSERT_EQ(there.status, Status::ok) << there.message << " seed " << kSeed << " trial " << trial;
    ASSERT_EQ(back.status, Status::ok) << back.message << " seed " << kSeed << " trial " << trial;
    EXPECT_NEAR(there.length, back.length, 1e-9 * there.length) << "seed " << kSeed << " trial " << trial;
    EXPECT_GE(there.length, (p - q).norm() * (1 - 1e-12));
  }
}

// GeographicLib's triaxial geodesics: x^2/2.25 + y^2 + z^2/0.25 = 1 from (1.5 cos w, sin w, 0), w = 20 deg to w = -175
// deg.
TEST(ShortestPath, TriaxialEllipsoidAgreesWithGeographicLib) {
  const auto on_equator = [](double degrees) {
    const double w = degrees * pi / 180;
    return Vector(Eigen::Vector3d(1.5 * std::cos(w), std::sin(w), 0));
  };
  const PathResult path = shortest_path(test::ellipsoid(1.5, 1, 0.5), on_equator(20), on_equator(-175));
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, 3.2689702, 5e-8);
}

TEST(ShortestPath, FollowsTheSharpRimOfAFlatEllipsoid) {
  // Axes 1 : 1 : 0.02, the rim's radius of curvature 0.0004; lengths from GeographicLib's GeodesicExact.
  struct Pair {
    Eigen::Vector3d from, to;
    double length;
  };
  const std::vector<Pair> pairs{
      {{0.7429387099798701, 0.073630634553076307, -0.013305947585478572},
       {0.41831216192227894, 0.2355626721463743, 0.01754451666680127},
       0.83277740096695674},
      {{-0.24559019838375476, 0.91795531179662315, -0.006230361145301044},
       {-0.80484054784205095, -0.46935601434844992, 0.0072646162828946467},
       1.5768011703284746},
      {{0.55826129820910342, 0.73777921855272932, -0.007590155402720301},
       {-0.26782387372778593, -0.96344258634936297, 0.00013965023436156803},
       1.8924221919571398},
      {{-0.054641176727752969, 0.95746390327204289, -0.0056666468298940537},
       {0.23413857355433895, 0.62053925122254194, 0.01496810163068258},
       0.5121406888460438},
  };
  PathSolver solver(parse_surface("x^2+y^2+(z/0.02)^2=1"));
  for (const Pair& pair : pairs) {
    const PathResult path = solver.solve(pair.from, pair.to);
    EXPECT_EQ(path.status, Status::ok) << path.message;
    EXPECT_LE(std::abs(path.length - pair.length), path.length_error + 1e-14) << pair.length;
  }
}

TEST(ShortestPath, DoesNotDependOnTheCells) {
  const Surface tangle = test::tangle_cube();
  const Vector p = Eigen::Vector3d(2, 0.7, 0.7);
  const Vector q = Eigen::Vector3d(0.7, 2, -0.7);
  const PathResult coarse = shortest_path(tangle, p, q, {.cell = 0.16});
  const PathResult fine = shortest_path(tangle, p, q, {.cell = 0.09});
  ASSERT_EQ(coarse.status, Status::ok) << coarse.message;
  ASSERT_EQ(fine.status, Status::ok) << fine.message;
  EXPECT_NEAR(coarse.length, fine.length, 1e-8);
}

// The paper's Figure 5: paths corrected from different grids are the same path.
TEST(ShortestPath, CorrectedPathsForgetTheGridTheyCameFrom) {
  struct Case {
    Surface surface;
    Vector from, to;
    double cell;
  };
  const std::vector<Case> cases = {
      {parse_surface("x^2+y^2+z^2=1", {.domain = {"z >= 0"}}), Eigen::Vector3d(0.8, 0, 0.6),
       Eigen::Vector3d(-0.6, 0.48, 0.64), 0.1},
      {test::ellipsoid(1, 0.8, 0.5), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0.64, 0.3), 0.1},
      {test::torus(), Eigen::Vector3d(1.4, 0, 0), Eigen::Vector3d(0, 1, 0.4), 0.1}};
  for (const CorrectionMethod method : {CorrectionMethod::flow, CorrectionMethod::newton}) {
    for (const Case& c : cases) {
      const PathResult coarse = shortest_path(c.surface, c.from, c.to, {.method = method, .cell = c.cell});
      const PathResult fine = shortest_path(c.surface, c.from, c.to, {.method = method, .cell = c.cell / 2});
      ASSERT_EQ(coarse.status, Status::ok) << coarse.message;
      ASSERT_EQ(fine.status, Status::ok) << fine.message;
      EXPECT_NEAR(coarse.length, fine.length, 1e-6);
    }
  }
}

TEST(ShortestPath, EveryMethodAgreesToItsAccuracy) {
  const Vector p = axis(3, 0);
  const Vector q = axis(3, 1);
  EXPECT_NEAR(shortest_path(test::unit_sphere(), p, q, {.method = CorrectionMethod::flow}).length, pi / 2, 1e-4);
  EXPECT_NEAR(shortest_path(test::unit_sphere(), p, q, {.method = CorrectionMethod::grid}).length, pi / 2, 0.02);
  for (const MarchMethod march : {MarchMethod::convergent, MarchMethod::axis, MarchMethod::dijkstra}) {
    for (const GridMethod grid : {GridMethod::subdivide, GridMethod::grow}) {
      const PathResult path = shortest_path(test::unit_sphere(), p, q, {.march = march, .grid = grid});
      ASSERT_EQ(path.status, Status::ok) << path.message;
      EXPECT_NEAR(path.length, pi / 2, 1e-9);
    }
  }
}

// A wall across the way, lower and narrower than a cell: cells of a size that was asked for cost time there, not truth.
TEST(ShortestPath, CellsAskedForAreRefinedWhereTheyMissAWall) {
  const Surface wall = parse_surface("z = 0.08 exp(-(50x)^2)", {.domain = {"x^2+y^2 <= 4"}});
  const Vector p = Eigen::Vector3d(-1, 0, 0);
  const Vector q = Eigen::Vector3d(1, 0.3, 0);
  const PathResult coarse = shortest_path(wall, p, q, {.cell = 0.3});
  ASSERT_EQ(coarse.status, Status::ok) << coarse.message;
  const PathResult fine = shortest_path(wall, p, q, {.cell = 0.02});
  ASSERT_EQ(fine.status, Status::ok) << fine.message;
  EXPECT_NEAR(fine.length, coarse.length, 1e-8);
  // The paper's march keeps to its cells, and says what that means.
  const PathResult kept = shortest_path(wall, p, q, {.march = MarchMethod::axis, .cell = 0.3});
  ASSERT_EQ(kept.status, Status::ok) << kept.message;
  EXPECT_EQ(kept.cell, 0.3);
  EXPECT_TRUE(kept.doubts.has(Doubt::rivals_not_sought));
  EXPECT_FALSE(kept.unique);
}

TEST(ShortestPath, SamePointHasLengthZero) {
  const PathResult path = shortest_path(test::unit_sphere(), axis(3, 0), axis(3, 0));
  EXPECT_EQ(path.status, Status::ok);
  EXPECT_EQ(path.length, 0);
  EXPECT_EQ(path.points.cols(), 2);
}

TEST(ShortestPath, VeryNearPointsAreAChordApart) {
  const Vector p = axis(3, 0);
  const Vector q = Eigen::Vector3d(std::cos(1e-9), std::sin(1e-9), 0);
  const PathResult path = shortest_path(test::unit_sphere(), p, q);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, 1e-9, 1e-15);
}

TEST(ShortestPath, FarFromTheOriginRoundingIsBlamedNotTheSurface) {
  const Surface far = parse_surface("(x-1e8)^2+y^2+z^2=1");
  const PathResult path = shortest_path(far, Eigen::Vector3d(1e8 + 1, 0, 0), Eigen::Vector3d(1e8, 0, 1));
  EXPECT_EQ(path.status, Status::not_converged);
  EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::no_geodesic) << path.message;
  EXPECT_GT(path.length_error, 1e-9 * path.length);
  EXPECT_LE(std::abs(path.length - std::numbers::pi / 2), path.length_error);
  // Of three digits there is no doubt.
  const PathResult rough =
      shortest_path(far, Eigen::Vector3d(1e8 + 1, 0, 0), Eigen::Vector3d(1e8, 0, 1), {.tolerance = 1e-3});
  EXPECT_EQ(rough.status, Status::ok) << rough.message;
}

TEST(ShortestPath, DifferentComponentsAreDisconnected) {
  const Surface two = parse_surface("(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0");
  const PathResult path = shortest_path(two, Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_EQ(path.points.cols(), 0);
  EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::apart);
  EXPECT_FALSE(path.message.empty());
}

TEST(ShortestPath, RefusesBadPoints) {
  const Surface sphere = test::unit_sphere();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)shortest_path(sphere, Eigen::Vector3d(nan, 0, 0), axis(3, 1)), InvalidArgument);
  EXPECT_THROW((void)shortest_path(sphere, Eigen::Vector2d(1, 0), axis(3, 1)), InvalidArgument);
  EXPECT_THROW((void)shortest_path(sphere, Eigen::Vector3d(9, 0, 0), axis(3, 1)), InvalidArgument);
  EXPECT_THROW((void)shortest_path(sphere, axis(3, 0), axis(3, 1), {.tolerance = 0}), InvalidArgument);
  EXPECT_THROW((void)shortest_path(sphere, axis(3, 0), axis(3, 1), {.cell = -1}), InvalidArgument);
}

TEST(ShortestPath, TheConesApexIsSingular) {
  const Surface cone = parse_surface("x^2+y^2=z^2");
  EXPECT_THROW((void)shortest_path(cone, Vector::Zero(3), Eigen::Vector3d(1, 0, 1)), Error);
}

// A cube's edges are crossed (tests/strata); those that no kink of the formula tells of are named, and so is the way
// through a cone's apex from one half to the other.
TEST(ShortestPath, ACreaseOrSingularPointInTheWayIsNamed) {
  const PathResult prism =
      shortest_path(parse_surface("sqrt(x^2)+sqrt(z^2)=1", {.dim = 3}), Eigen::Vector3d(0.7, 0.2, 0.3),
                    Eigen::Vector3d(-0.3, 0.1, 0.7), {.cell = 0.25});
  EXPECT_EQ(prism.status, Status::not_converged);
  EXPECT_EQ(prism.obstacle.kind, Obstacle::Kind::crease) << prism.message;
  EXPECT_NEAR(prism.obstacle.size, std::numbers::pi / 2, 0.01);
  const PathResult cone =
      shortest_path(parse_surface("x^2+y^2=z^2"), Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(-1, 0, -1), {.cell = 0.5});
  EXPECT_EQ(cone.status, Status::not_converged);
  EXPECT_EQ(cone.obstacle.kind, Obstacle::Kind::singular_between) << cone.message;
  EXPECT_LT(cone.obstacle.place.norm(), 1e-9);
  const PathResult face = shortest_path(parse_surface("max(abs(x),max(abs(y),abs(z)))=1"), Eigen::Vector3d(1, 0.2, 0.3),
                                        Eigen::Vector3d(1, -0.5, 0.1), {.cell = 0.1});
  ASSERT_EQ(face.status, Status::ok) << face.message;
  EXPECT_NEAR(face.length, std::hypot(0.7, 0.2), 1e-9);
}

TEST(PathSolver, OneSourceToManyEqualsPairByPair) {
  PathSolver solver(test::torus());
  Points targets(3, 4);
  targets << -1.4, 0, 1, -0.6,  //
      0, 1.4, 0, 0,             //
      0, 0, 0.4, 0;
  const Vector p = Eigen::Vector3d(0.6, 0, 0);
  const std::vector<PathResult> paths = solver.solve_from(p, targets);
  ASSERT_EQ(paths.size(), 4U);
  for (Index j = 0; j < 4; ++j) {
    const PathResult single = solver.solve(p, targets.col(j));
    ASSERT_EQ(paths[static_cast<std::size_t>(j)].status, Status::ok);
    EXPECT_NEAR(paths[static_cast<std::size_t>(j)].length, single.length, 1e-8) << "target " << j;
  }
}

TEST(PathSolver, ABadTargetCarriesItsReasonAndTheRestGoesOn) {
  PathSolver solver(test::unit_sphere());
  Points targets(3, 3);
  targets << 0, 50, 0, 1, 0, 0, 0, 0, 1;
  targets(1, 2) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<PathResult> paths = solver.solve_from(axis(3, 0), targets);
  EXPECT_EQ(paths[0].status, Status::ok);
  EXPECT_NE(paths[1].status, Status::ok);
  EXPECT_FALSE(paths[1].message.empty());
  EXPECT_NE(paths[2].status, Status::ok);
}

TEST(PathSolver, ThreadsDoNotChangeTheResult) {
  const Vector p = Eigen::Vector3d(1.4, 0, 0);
  const Vector q = Eigen::Vector3d(-1, 0, 0.4);
  const PathResult one = shortest_path(test::torus(), p, q, {}, {.threads = 1});
  const PathResult four = shortest_path(test::torus(), p, q, {}, {.threads = 4});
  EXPECT_EQ(one.length, four.length);
  EXPECT_EQ(one.points, four.points);
}

// A correction that is taken to its limits (a rim 2,500 times as sharp as the body is wide) must not meet what an
// earlier one has left in its buffers.
TEST(PathSolver, AnswersDoNotDependOnWhatWasAskedBefore) {
  const Surface disc = parse_surface("x^2+y^2+z^2/0.0004=1");
  constexpr Index kPairs = 3;
  Points from(3, kPairs), to(3, kPairs);
  from << -0.84976086, 0.395410285, 0.812471584, 0.30875513, 0.709678255, -0.551859762, 0.00854580016, 0.0116620321,
      0.00375982592;
  to << 0.460458541, 0.208860177, 0.709999975, 0.478628646, -0.183938383, 0.678078595, -0.0149518233, -0.0192098318,
      -0.00380049763;
  PathSolver solver(disc);
  const std::vector<PathResult> there = solver.solve_pairs(from, to);
  const std::vector<PathResult> back = solver.solve_pairs(from.rowwise().reverse(), to.rowwise().reverse());
  for (Index j = 0; j < kPairs; ++j) {
    const PathResult& one = there[static_cast<std::size_t>(j)];
    const PathResult& other = back[static_cast<std::size_t>(kPairs - 1 - j)];
    EXPECT_EQ(one.length, other.length) << "pair " << j;
    EXPECT_EQ(one.num_iterations, other.num_iterations) << "pair " << j;
  }
}

}  // namespace
}  // namespace taut
