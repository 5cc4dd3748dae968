// Paths along borders in more than three dimensions: closed forms, and the same surface in R^3.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

using std::numbers::pi;

Surface surface(const std::string& formula, Index dim, const std::vector<std::string>& domain) {
  FormulaOptions options;
  options.dim = dim;
  options.domain = domain;
  return parse_surface(formula, options);
}

std::string squares(Index dim) {
  std::string text;
  for (Index i = 1; i <= dim; ++i) text += (i > 1 ? "+x" : "x") + std::to_string(i) + "^2";
  return text;
}

double angle(const Vector& a, const Vector& b) { return 2 * std::atan2((a - b).norm(), (a + b).norm()); }

/// From p to q on the unit sphere round a forbidden cap about c, of this radius (radians), by the spherical triangles
/// p c tangent point; nothing where the great circle does not meet the cap.
std::optional<double> round_cap(const Vector& p, const Vector& q, const Vector& c, double radius) {
  const Vector w = (q - p.dot(q) * p).normalized();
  const double nearest = std::atan2(c.dot(w), c.dot(p));
  if (!(nearest > 0 && nearest < angle(p, q))) return std::nullopt;
  if (angle(std::cos(nearest) * p + std::sin(nearest) * w, c) > radius) return std::nullopt;
  const auto tangent = [&](const Vector& x) { return std::acos(std::cos(angle(x, c)) / std::cos(radius)); };
  const auto turn = [&](const Vector& x) { return std::acos(std::tan(radius) / std::tan(angle(x, c))); };
  const Vector a = (p - p.dot(c) * c).normalized();
  const Vector b = (q - q.dot(c) * c).normalized();
  return tangent(p) + tangent(q) + std::sin(radius) * (angle(a, b) - turn(p) - turn(q));
}

/// Random pairs between which a cap of 41 degrees stands, and back again.
void compare_round_cap(Index dim, Index num_pairs, std::uint64_t seed) {
  PathSolver solver(surface(squares(dim) + "=1", dim, {squares(dim) + "-2*x1+0.5>=0"}));
  const double radius = std::acos(0.75);
  const Vector c = Vector::Unit(dim, 0);
  std::mt19937_64 random(seed);
  Points from(dim, 2 * num_pairs);
  Points to(dim, 2 * num_pairs);
  std::vector<double> length;
  while (static_cast<Index>(length.size()) < num_pairs) {
    const Vector p = (detail::random_direction(dim, random) + 0.3 * c).normalized();
    const Vector q = (detail::random_direction(dim, random) + 0.3 * c).normalized();
    if (angle(p, c) < radius + 1e-3 || angle(q, c) < radius + 1e-3) continue;
    const std::optional<double> truth = round_cap(p, q, c, radius);
    if (!truth) continue;
    const auto at = 2 * static_cast<Index>(length.size());
    from.col(at) = to.col(at + 1) = p;
    to.col(at) = from.col(at + 1) = q;
    length.push_back(*truth);
  }
  const std::vector<PathResult> found = solver.solve_pairs(from, to);
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].status, Status::ok) << found[i].message;
    EXPECT_NEAR(found[i].length, length[i / 2], 1e-11);
    EXPECT_TRUE(found[i].locally_shortest);
    EXPECT_FALSE(found[i].unique);
    EXPECT_TRUE(found[i].doubts.has(Doubt::rivals_not_sought));
    ASSERT_EQ(found[i].pieces.size(), 3U);
    EXPECT_EQ(found[i].pieces[1].kind, PathPiece::Kind::border);
  }
}

TEST(ContactSearch, HypersphereWithAForbiddenBallInFourDimensions) { compare_round_cap(4, 6, 1); }
TEST(ContactSearch, HypersphereWithAForbiddenBallInSixDimensions) { compare_round_cap(6, 2, 2); }
TEST(ContactSearch, HypersphereWithAForbiddenBallInNineDimensions) { compare_round_cap(9, 6, 3); }

// All ways round are as long: which of them is found does not matter, and it is said that there is no single one.
TEST(ContactSearch, ThroughTheMiddleOfTheObstacle) {
  const Vector p = Eigen::Vector4d(-2, 0, 0, 0);
  const PathResult found = shortest_path(surface("x4=0", 4, {"x1^2+x2^2+x3^2>=1"}), p, -p);
  ASSERT_EQ(found.status, Status::ok) << found.message;
  EXPECT_NEAR(found.length, 2 * std::sqrt(3.0) + pi / 3, 1e-10);
  EXPECT_FALSE(found.locally_shortest);
  EXPECT_EQ(found.index, 0);
  EXPECT_FALSE(found.unique);
}

// A graze, over arcs that are ever shorter, and one that just misses.
TEST(ContactSearch, Grazes) {
  const auto round = [](double height) {
    const PathResult found = shortest_path(surface("x4=0", 4, {"x1^2+x2^2+x3^2>=1"}), Eigen::Vector4d(-3, height, 0, 0),
                                           Eigen::Vector4d(3, height, 0, 0));
    EXPECT_EQ(found.status, Status::ok) << found.message;
    return found.length;
  };
  for (const double height : {0.9, 0.99, 0.999, 0.9999, 0.99999}) {
    const double reach = std::hypot(3, height);
    const double exact = 2 * std::sqrt(reach * reach - 1) + 2 * (std::asin(3 / reach) - std::acos(1 / reach));
    EXPECT_NEAR(round(height), exact, 1e-10) << height;
  }
  EXPECT_NEAR(round(1.001), 6, 4e-15);
}

TEST(ContactSearch, EndsOnTheBorder) {
  const Surface space = surface("x4=0", 4, {"x1^2+x2^2+x3^2>=1"});
  const PathResult along = shortest_path(space, Eigen::Vector4d(1, 0, 0, 0), Eigen::Vector4d(-0.6, 0.8, 0, 0));
  ASSERT_EQ(along.status, Status::ok) << along.message;
  EXPECT_NEAR(along.length, std::acos(-0.6), 1e-11);
  const PathResult away = shortest_path(space, Eigen::Vector4d(1, 0, 0, 0), Eigen::Vector4d(-2, 0.01, 0, 0));
  ASSERT_EQ(away.status, Status::ok) << away.message;
  const double reach = std::hypot(2, 0.01);
  EXPECT_NEAR(away.length, std::sqrt(reach * reach - 1) + std::atan2(0.01, -2) - std::acos(1 / reach), 1e-10);
}

// Several obstacles in a row, in a plane of symmetry; the plane itself with discs is answered by other means.
TEST(ContactSearch, ThreeBallsInARow) {
  const std::string balls[] = {"(x1+2)^2+(x2+0.3)^2+x3^2-1", "x1^2+(x2+0.1)^2+x3^2-0.8",
                               "(x1-2.2)^2+(x2+0.4)^2+x3^2-1"};
  const std::string discs[] = {"(x+2)^2+(y+0.3)^2-1", "x^2+(y+0.1)^2-0.8", "(x-2.2)^2+(y+0.4)^2-1"};
  std::vector<std::string> in_space;
  std::vector<std::string> in_plane;
  for (const std::string& ball : balls) in_space.push_back(ball + ">=0");
  for (const std::string& disc : discs) in_plane.push_back(disc + ">=0");
  const PathResult space =
      shortest_path(surface("x4=0", 4, in_space), Eigen::Vector4d(-4, 0, 0, 0), Eigen::Vector4d(4, 0.1, 0, 0));
  const PathResult plane =
      shortest_path(surface("z=0", 3, in_plane), Eigen::Vector3d(-4, 0, 0), Eigen::Vector3d(4, 0.1, 0));
  ASSERT_EQ(space.status, Status::ok) << space.message;
  ASSERT_EQ(plane.status, Status::ok) << plane.message;
  EXPECT_EQ(space.pieces.size(), plane.pieces.size());
  EXPECT_NEAR(space.length, plane.length, 1e-10);
}

// A cylinder with a window, in R^3 and as two equations in R^4.
TEST(ContactSearch, TwoEquations) {
  const PathResult four =
      shortest_path(surface("x3^2+x4^2=1;x1=0.5", 4, {"x2^2+(x3-1)^2>=0.5"}), Eigen::Vector4d(0.5, -2, 1, 0),
                    Eigen::Vector4d(0.5, 2, std::cos(0.1), std::sin(0.1)));
  const PathResult three = shortest_path(surface("y^2+z^2=1", 3, {"x^2+(y-1)^2>=0.5"}), Eigen::Vector3d(-2, 1, 0),
                                         Eigen::Vector3d(2, std::cos(0.1), std::sin(0.1)));
  ASSERT_EQ(four.status, Status::ok) << four.message;
  ASSERT_EQ(three.status, Status::ok) << three.message;
  EXPECT_NEAR(four.length, three.length, 1e-10);
}

// What cannot be answered is refused with its place; nothing is longer than it may be.
TEST(ContactSearch, BordersThatMeetAreRefused) {
  const PathResult found = shortest_path(surface("x4=0", 4, {"max(abs(x1),abs(x2),abs(x3))>=1"}),
                                         Eigen::Vector4d(-2, 0.1, 0.2, 0), Eigen::Vector4d(2, 0.2, 0.1, 0));
  EXPECT_EQ(found.status, Status::left_domain);
  EXPECT_EQ(found.obstacle.kind, Obstacle::Kind::faces);
  EXPECT_EQ(found.obstacle.place.size(), 4);
}

TEST(ContactSearch, AnObstacleThatIsNotMetChangesNothing) {
  const std::string sphere = squares(4) + "=1";
  const Vector p = Vector::Unit(4, 0);
  const Vector q = Eigen::Vector4d(0.6, 0.8, 0, 0);
  const PathResult with = shortest_path(surface(sphere, 4, {"x1>=-0.9"}), p, q);
  const PathResult without = shortest_path(surface(sphere, 4, {}), p, q);
  EXPECT_EQ(with.length, without.length);
  EXPECT_TRUE(with.unique);
}

}  // namespace
}  // namespace taut
