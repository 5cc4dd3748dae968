// Paths where there are too many dimensions for cells.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using std::numbers::pi;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// M^T M = I in R^9, row-major.
Surface orthogonal_matrices() {
  return parse_surface(
      "x1*x1+x4*x4+x7*x7=1; x1*x2+x4*x5+x7*x8; x1*x3+x4*x6+x7*x9; x2*x2+x5*x5+x8*x8=1; x2*x3+x5*x6+x8*x9;"
      "x3*x3+x6*x6+x9*x9=1");
}
Matrix rotation(const Vector& axis, double angle) {
  const Eigen::Vector3d a = axis.normalized();
  Matrix cross;
  cross << 0, -a(2), a(1), a(2), 0, -a(0), -a(1), a(0), 0;
  return Matrix::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * cross * cross;
}
Vector coordinates(const Matrix& m) { return Eigen::Map<const Vector>(m.data(), 9); }

/// A chain of five links of length 1 from the origin whose end stays 3 away from it: R^15, 6 equations.
Surface chain() {
  std::string text;
  for (int link = 0; link < 5; ++link) {
    for (int c = 1; c <= 3; ++c) {
      text += "+(x" + std::to_string(3 * link + c);
      if (link > 0) text += "-x" + std::to_string(3 * link + c - 3);
      text += ")^2";
    }
    text += "=1;";
  }
  return parse_surface(text + "x13^2+x14^2+x15^2=9");
}

// Cells that grow with the march until the memory allowed is used up: the walks' path, and why it is theirs.
TEST(ManyDimensions, WhereNoMoreCellsMayGrowTheWalksPathIsGiven) {
  const Surface sphere = parse_surface("x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1");
  const Vector p = Vector::Unit(7, 0);
  const Vector q = 0.6 * Vector::Unit(7, 1) - 0.8 * Vector::Unit(7, 4);
  const Context context{.memory_limit = 2'000'000};
  PathOptions options{.march = MarchMethod::axis, .grid = GridMethod::grow, .cell = 0.25};
  const PathResult path = shortest_path(sphere, p, q, options, context);
  EXPECT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, pi / 2, 1e-8);
  EXPECT_TRUE(path.doubts.has(Doubt::cells_spent)) << path.message;
  EXPECT_FALSE(path.unique);
  options.method = CorrectionMethod::grid;
  const PathResult none = shortest_path(sphere, p, q, options, context);
  EXPECT_EQ(none.status, Status::not_converged);
  EXPECT_EQ(none.obstacle.kind, Obstacle::Kind::cells_spent);
  EXPECT_FALSE(none.message.empty());
  EXPECT_EQ(none.points.cols(), 0);
}

TEST(ManyDimensions, RotationsUpToTheCutLocusHaveTheBiInvariantDistance) {
  PathSolver solver(orthogonal_matrices());
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double angle : {0.2, 1.7, 3.0, pi - 1e-2, pi - 1e-3, pi - 1e-5}) {
    const Matrix from =
        rotation(Eigen::Vector3d(uniform(random), uniform(random), uniform(random)), 2 * uniform(random));
    const Matrix to = from * rotation(Eigen::Vector3d(uniform(random), uniform(random), 1), angle);
    const PathResult path = solver.solve(coordinates(from), coordinates(to));
    ASSERT_EQ(path.status, Status::ok) << path.message << " at " << angle;
    EXPECT_NEAR(path.length, std::sqrt(2.0) * angle, 1e-9) << angle;
    EXPECT_EQ(path.points.col(0), path.from);
    EXPECT_EQ(path.points.rightCols<1>(), path.to);
  }
}

// The walks that start such pairs differ in length by more than the two ways round do.
TEST(ManyDimensions, TheShorterWayRoundIsFoundBesideTheCutLocus) {
  using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  std::string equations;  // M^T M = I, row-major
  for (int i = 1; i <= 4; ++i) {
    for (int j = i; j <= 4; ++j) {
      for (int row = 0; row < 16; row += 4)
        equations += "+x" + std::to_string(row + i) + "*x" + std::to_string(row + j);
      equations += i == j ? "=1;" : "=0;";
    }
  }
  PathSolver solver(parse_surface(equations));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto random_rotation = [&]() -> Matrix4 {
    const Matrix4 numbers = Matrix4::NullaryExpr([&] { return normal(random); });
    Matrix4 m = Eigen::HouseholderQR<Matrix4>(numbers).householderQ();
    if (m.determinant() < 0) m.row(0) *= -1;
    return m;
  };
  for (int k = 0; k < 12; ++k) {
    const double short_of_pi = std::pow(10.0, -1 - 4 * std::generate_canonical<double, 53>(random));
    const double angles[2] = {pi - short_of_pi, pi * std::generate_canonical<double, 53>(random)};
    Matrix4 turn = Matrix4::Zero();
    for (int plane = 0; plane < 2; ++plane) {
      turn.block<2, 2>(2 * plane, 2 * plane) = Eigen::Rotation2Dd(angles[plane]).toRotationMatrix();
    }
    const Matrix4 from = random_rotation();
    const Matrix4 axes = random_rotation();
    const Matrix4 to = from * axes * turn * axes.transpose();
    const PathResult path = solver.solve(from.reshaped<Eigen::RowMajor>(), to.reshaped<Eigen::RowMajor>());
    ASSERT_EQ(path.status, Status::ok) << path.message;
    EXPECT_NEAR(path.length, std::sqrt(2.0) * std::hypot(angles[0], angles[1]), 1e-9) << k;
  }
}

TEST(ManyDimensions, ReflectionsAreNotReachedFromRotations) {
  Matrix mirror = Matrix::Identity();
  mirror(2, 2) = -1;
  const PathResult path = shortest_path(orthogonal_matrices(), coordinates(Matrix::Identity()), coordinates(mirror));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::apart_by_walks) << path.message;
}

TEST(ManyDimensions, TwoCloseSheetsAreNotJoined) {
  std::string squares;
  for (int i = 1; i <= 8; ++i) squares += "+x" + std::to_string(i) + "^2";
  const Surface shells = parse_surface("(" + squares + "-1)*(" + squares + "-1.0201)");
  const Vector inner = Vector::Unit(8, 0);
  EXPECT_EQ(shortest_path(shells, inner, -1.01 * inner).status, Status::disconnected);
  EXPECT_EQ(shortest_path(shells, inner, 1.01 * inner).status, Status::disconnected);
  EXPECT_EQ(shortest_path(shells, inner, Vector(Vector::Unit(8, 3))).status, Status::ok);
}

TEST(ManyDimensions, AntipodesOfASphere) {
  std::string squares;
  for (int i = 1; i <= 40; ++i) squares += "+x" + std::to_string(i) + "^2";
  const PathResult path = shortest_path(parse_surface(squares + "=1"), Vector::Unit(40, 2), -Vector::Unit(40, 2));
  EXPECT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, pi, 1e-9);
}

TEST(ManyDimensions, AKinematicChainTurnsRound) {
  const Vector pose{{1, 0, 0, 2, 0, 0, 2, -1, 0, 3, -1, 0, 3, 0, 0}};
  PathSolver solver(chain());
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double spread : {1e-4, 1e-3, 1e-2, 0.1}) {
    Vector p = pose;
    Vector q = -pose;
    for (double& x : p) x += spread * normal(random);
    for (double& x : q) x += spread * normal(random);
    const PathResult path = solver.solve(p, q);
    ASSERT_EQ(path.status, Status::ok) << path.message << " at " << spread;
    EXPECT_TRUE(path.locally_shortest) << spread;
    EXPECT_LE(path.length_error, 1e-9 * path.length) << spread;
    EXPECT_NEAR(path.length, 14.173, 5 * spread) << spread;
  }
}

TEST(ManyDimensions, RivalsAreClaimedOnlyWhereTheyWereSought) {
  // Two rotations 3 radians apart: the other way round is 2 pi - 3.
  const Vector from = coordinates(Matrix::Identity());
  const Vector to = coordinates(rotation(Eigen::Vector3d(1, 2, 3), 3.0));
  const PathResult straight = shortest_path(orthogonal_matrices(), from, to);
  EXPECT_EQ(straight.doubts, Doubts{Doubt::rivals_not_sought});
  EXPECT_FALSE(straight.unique);
  const PathResult all = shortest_path(orthogonal_matrices(), from, to, {.all = true});
  // Sought at random: that they are all is not proved.
  EXPECT_EQ(all.doubts, Doubts{Doubt::random_search});
  EXPECT_FALSE(all.unique);
  EXPECT_FALSE(all.tied);
  EXPECT_NEAR(all.length, straight.length, 1e-9);
  ASSERT_GE(all.candidates.size(), 2u);
  EXPECT_NEAR(all.candidates[1].length, std::sqrt(2.0) * (2 * pi - 3), 1e-9);
}

// Half a turn about the z axis takes this pose to its mirror image, so that the middle of a shortest way, by symmetry,
// has all links along that axis, and with its end at 3 one of them turned back: the equations depend on each other
// there.
TEST(ManyDimensions, AWayThroughASingularPoseIsSaidToBeOne) {
  const Vector pose{{1, 0, 0, 2, 0, 0, 2, -1, 0, 3, -1, 0, 3, 0, 0}};
  const PathResult path = shortest_path(chain(), pose, -pose);
  EXPECT_EQ(path.status, Status::rank_deficient);
  EXPECT_FALSE(path.locally_shortest);
  EXPECT_EQ(path.obstacle.place.size(), 15) << path.message;
  EXPECT_NEAR(path.length, 14.172985754, 1e-8);  // of perturbed poses, to where they meet
}

// Beside the singular point the second variation is as large as its inverse distance: curves that pass it at 1e-6 came
// out as certain minima.
TEST(ManyDimensions, PosesOffASingularWayByRoundingAreNotCalledMinima) {
  const Surface surface = chain();
  const auto evaluator = surface.make_evaluator();
  const Vector pose{{1, 0, 0, 2, 0, 0, 2, -1, 0, 3, -1, 0, 3, 0, 0}};
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 1e-14);
  for (const double tolerance : {1e-9, 1e-12}) {
    PathSolver solver(surface, {.tolerance = tolerance});
    Points ends(15, 2);
    ends << pose, -pose;
    for (double& x : ends.reshaped()) x += normal(random);
    ASSERT_TRUE(project_to_surface(*evaluator, 15, surface.codim(), ends).all());
    const PathResult path = solver.solve(ends.col(0), ends.col(1));
    EXPECT_EQ(path.status, Status::rank_deficient) << tolerance;
    EXPECT_FALSE(path.locally_shortest) << tolerance;
    EXPECT_NEAR(path.length, 14.172985754, path.length_error + 1e-8) << tolerance;
  }
}

// Walks towards the far end used to step over singular poses onto other sheets, from where no correction began.
TEST(ManyDimensions, ChainsTurnBetweenRandomPoses) {
  const Surface surface = chain();
  PathSolver solver(surface);
  const auto evaluator = surface.make_evaluator();
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 12; ++i) {
    Points ends(15, 2);
    for (double& x : ends.reshaped()) x = normal(random);
    if (i % 2 == 1) ends.col(1) = -ends.col(0);
    ASSERT_TRUE(project_to_surface(*evaluator, 15, surface.codim(), ends).all());
    const PathResult path = solver.solve(ends.col(0), ends.col(1));
    EXPECT_EQ(path.status, Status::ok) << path.message << " in pair " << i;
    EXPECT_TRUE(path.locally_shortest) << i;
    EXPECT_LE(path.length_error, 1e-9 * path.length) << i;
  }
}

TEST(ManyDimensions, SamplesShowTheWay) {
  // A circle in R^7. The end lies straight behind it, so that a walk towards it does not even begin.
  const Surface circle = parse_surface("x1^2+x2^2=1; x3; x4; x5; x6; x7");
  auto cloud = std::make_shared<PointCloud>();
  cloud->points = Points::Zero(7, 30);
  for (Index i = 0; i < 30; ++i) {
    cloud->points(0, i) = std::cos(0.5 + 0.2 * static_cast<double>(i));
    cloud->points(1, i) = std::sin(0.5 + 0.2 * static_cast<double>(i));
  }
  Vector p = Vector::Zero(7);
  Vector q = Vector::Zero(7);
  p(0) = 1;
  q(0) = -1;  // straight behind
  const PathResult path = shortest_path(circle.with_samples(cloud), p, q);
  ASSERT_EQ(path.status, Status::ok) << path.message;
  EXPECT_NEAR(path.length, pi, 1e-9);
}

// Fourteen ways are as short: along one of the other axes, to one side or the other. Random searches cannot know that.
TEST(ManyDimensions, NoPathIsCalledTheOnlyOneByRandomSearches) {
  const Surface ball = parse_surface("x1^4+x2^4+x3^4+x4^4+x5^4+x6^4+x7^4+x8^4=1");
  for (const bool all : {false, true}) {
    const PathResult path = shortest_path(ball, Vector::Unit(8, 0), -Vector::Unit(8, 0), {.all = all});
    ASSERT_EQ(path.status, Status::ok) << path.message;
    EXPECT_FALSE(path.unique);
    EXPECT_TRUE(path.tied || path.doubts.has(Doubt::random_search));
  }
}

TEST(ManyDimensions, PairsOfWhichNoneIsFiniteAreAnsweredAll) {
  const Points nothing = Points::Constant(8, 2, std::nan(""));
  PathSolver solver(parse_surface("x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2+x8^2=1"));
  for (const PathResult& path : solver.solve_pairs(nothing, nothing)) {
    EXPECT_EQ(path.obstacle.kind, Obstacle::Kind::refused) << path.message;
  }
  EXPECT_NEAR(solver.solve(Vector::Unit(8, 0), Vector::Unit(8, 1)).length, pi / 2, 1e-9);
}

}  // namespace
}  // namespace taut
