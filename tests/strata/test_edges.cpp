// Paths over edges against unfolded faces: lengths that a ruler gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double kPi = 3.14159265358979323846;

PathResult path(const std::string& formula, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  FormulaOptions options;
  options.dim = 3;
  return shortest_path(parse_surface(formula, options), p, q);
}

void expect_length(const PathResult& found, double length, double tolerance = 1e-12) {
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_EQ(found.message, "");
  EXPECT_NEAR(found.length, length, tolerance * length);
  EXPECT_LE(std::abs(found.length - length), found.length_error + 1e-13 * length);
  EXPECT_TRUE(found.locally_shortest);
}

/// Least value of a function that falls, then rises.
double least(const std::function<double(double)>& f, double a, double b) {
  const double part = (std::sqrt(5.0) - 1) / 2;
  for (int i = 0; i < 90; ++i) {
    const double x = b - part * (b - a);
    const double y = a + part * (b - a);
    (f(x) < f(y) ? b : a) = f(x) < f(y) ? y : x;
  }
  return f((a + b) / 2);
}

const std::string kCan = "max(x^2+y^2-4, abs(z)-1)";

TEST(Edges, CanOverTheLid) {
  const PathResult found = path(kCan, {2, 0, 0.9}, {-2, 0, 0.9});
  expect_length(found, 4.2);
  EXPECT_TRUE(found.unique);
  ASSERT_EQ(found.pieces.size(), 5U);
  EXPECT_EQ(found.pieces[0].kind, PathPiece::Kind::face);
  EXPECT_EQ(found.pieces[1].kind, PathPiece::Kind::crossing);
  EXPECT_NEAR(found.pieces[1].left, kPi / 2, 1e-9);
  EXPECT_NEAR(found.pieces[2].length, 4, 1e-11);
}

TEST(Edges, CanFromLidToSide) {
  expect_length(path(kCan, {0.5, 0, 1}, {2, 0, 0}), 2.5);
  for (const double angle : {0.4, 1.1, 1.9}) {
    // Straight on the lid to the rim, then a helix.
    const double want = least(
        [&](double rim) {
          const double lid = std::hypot(2 * std::cos(rim) - 0.5, 2 * std::sin(rim));
          return lid + std::hypot(2 * (angle - rim), 0.7);
        },
        0, angle);
    expect_length(path(kCan, {0.5, 0, 1}, {2 * std::cos(angle), 2 * std::sin(angle), 0.3}), want, 1e-11);
  }
}

TEST(Edges, SpiderAndFlyInTheBox) {
  // Dudeney's room: five of the six faces, 40 and not 42.
  const PathResult found = path("max(abs(x)-15,abs(y)-6,abs(z)-6)", {-15, 0, 5}, {15, 0, -5});
  expect_length(found, 40);
  EXPECT_FALSE(found.unique);  // its mirror image is as short
  int faces = 0;
  for (const PathPiece& piece : found.pieces) faces += piece.kind == PathPiece::Kind::face ? 1 : 0;
  EXPECT_EQ(faces, 5);
}

TEST(Edges, Cube) {
  const std::string cube = "max(abs(x),abs(y),abs(z))-1";
  expect_length(path(cube, {0.2, 0.3, 1}, {1, -0.4, 0.1}), std::hypot(0.8 + 0.9, 0.7));
  const PathResult opposite = path(cube, {0, 0, 1}, {0, 0, -1});
  expect_length(opposite, 4);
  EXPECT_FALSE(opposite.unique);
}

TEST(Edges, RoofAndWedge) {
  expect_length(path("z=abs(x)", {-1, 0, 1}, {1, 1, 1}), 3);
  // Of any angle, both ways the same.
  for (const double slope : {0.2, 1.0, 4.0}) {
    const std::string wedge = "z+" + std::to_string(slope) + "*max(x,0)";
    const double across = std::hypot(1, slope) * 0.8;
    const PathResult found = path(wedge, {-0.5, 0, 0}, {0.8, 1.3, -0.8 * slope});
    expect_length(found, std::hypot(0.5 + across, 1.3));
    const PathResult back = path(wedge, {0.8, 1.3, -0.8 * slope}, {-0.5, 0, 0});
    EXPECT_NEAR(back.length, found.length, 1e-13);
  }
}

TEST(Edges, Staircase) { expect_length(path("min(z, max(x, z-1))", {2, 0, 0}, {-1, 1.5, 1}), std::hypot(4, 1.5)); }

TEST(Edges, Lens) {
  const double angle = 35 * kPi / 180;  // of the ends above the flat face's plane; the rim is at 30 degrees
  const PathResult found =
      path("max(x^2+y^2+z^2-1, 0.5-z)", {std::cos(angle), 0, std::sin(angle)}, {-std::cos(angle), 0, std::sin(angle)});
  expect_length(found, 2 * 5 * kPi / 180 + std::sqrt(3.0), 1e-11);
}

TEST(Edges, HalfBar) {
  // Flat below, round above: the flat strip and the cylinder unroll into one plane.
  expect_length(path("max(x^2+z^2-1, -z)", {0.5, 0, 0}, {std::cos(1), 0.7, std::sin(1)}), std::hypot(0.5 + 1, 0.7));
}

TEST(Edges, ConeWithBase) {
  // Slant sqrt(2): the cone unrolls to a sector with angles divided by sqrt(2).
  const double angle = 0.8;
  const double r = 0.6;
  const double want = least(
      [&](double rim) {
        const double base = std::hypot(std::cos(rim) - 0.3, std::sin(rim));
        const double slant = std::sqrt(2.0) * r;
        const double turn = (angle - rim) / std::sqrt(2.0);
        return base + std::sqrt(slant * slant + 2 - 2 * slant * std::sqrt(2.0) * std::cos(turn));
      },
      0, angle);
  expect_length(path("max(sqrt(x^2+y^2)+z-1, -z)", {0.3, 0, 0}, {r * std::cos(angle), r * std::sin(angle), 1 - r}),
                want, 1e-11);
}

TEST(Edges, CrossedCylinders) {
  expect_length(path("max(x^2+y^2,x^2+z^2,y^2+z^2)=2", {1, 1, 0}, {0, 1, 1}), 1.5485624144820531, 1e-11);
}

TEST(Edges, Vault) {
  // max(x^2+z^2, y^2+z^2) = 1: the cylinders meet where |x| = |y|. From one to the other over x = y.
  const double a = 0.3;
  const double b = 0.5;
  // On x^2+z^2=1 with |y|<=|x|: p = (sin u, y, cos u).
  const Eigen::Vector3d p(std::sin(0.9), a, std::cos(0.9));
  const Eigen::Vector3d q(b, std::sin(0.8), std::cos(0.8));
  const double want = least(
      [&](double u) { return std::hypot(0.9 - u, a - std::sin(u)) + std::hypot(0.8 - u, b - std::sin(u)); }, 0.1, 1.4);
  expect_length(path("max(x^2+z^2,y^2+z^2)=1", p, q), want, 1e-11);
}

TEST(Edges, Octahedron) {
  const PathResult found = path("abs(x)+abs(y)+abs(z)=1", {1, 0, 0}, {-1, 0, 0});
  expect_length(found, std::sqrt(6.0));
  EXPECT_FALSE(found.unique);
}

TEST(Edges, CornersOfAngleAbovePi) {
  // A box on the floor: round its foot, over two corners.
  const PathResult found = path("min(z, max(abs(x)-1,abs(y)-1,z-1))", {-2, 0.1, 0}, {2, 0.1, 0});
  expect_length(found, 2 * std::hypot(1, 0.9) + 2);
  int corners = 0;
  for (const PathPiece& piece : found.pieces) {
    if (piece.kind != PathPiece::Kind::corner) continue;
    ++corners;
    EXPECT_GE(std::min(piece.left, piece.right), kPi - 1e-9);
  }
  EXPECT_EQ(corners, 2);
}

TEST(Edges, LevelTopsOfTwoBars) {
  // The tops of two crossed bars are one face with four corners that reach into it.
  const PathResult found = path("min(max(abs(x)-1,abs(y)-0.3,abs(z)-0.3),max(abs(x)-0.3,abs(y)-1,abs(z)-0.3))",
                                {-0.1, -0.5, 0.3}, {-0.9, -0.3, 0.1});
  expect_length(found, std::hypot(0.2, 0.2) + std::hypot(0.6, 0.2), 1e-11);
}

TEST(Edges, SlabWithATower) {
  // From below over an edge and round the tower's foot on the top: found from one end only, before corners were tried.
  const std::string tower = "min(max(abs(x)-1,abs(y)-1,abs(z)-0.2),max(abs(x)-0.4,abs(y)-0.4,abs(z-0.5)-0.6))";
  const Eigen::Vector3d above(-0.7, -0.02, 0.2);
  const Eigen::Vector3d below(0.9, -0.03, -0.2);
  const double want = std::hypot(0.1 + 0.4 + 0.6, 0.37) + 0.8 + std::hypot(0.3, 0.38);
  expect_length(path(tower, above, below), want, 1e-11);
  expect_length(path(tower, below, above), want, 1e-11);
}

TEST(Edges, BoredBlock) {
  // From a wall over the lid into the bore: the crossing of the rim that is seen, not the one behind the hole.
  const std::string block = "max(max(abs(x)-1,abs(y)-1),max(abs(z)-1,0.5-x^2-y^2))";
  const double r = std::sqrt(0.5);
  const double at = 200 * kPi / 180;  // of the end in the bore, 0.05 deep; the start is on the lid at 270 degrees
  const double want = least(
      [&](double rim) {
        const double lid = std::hypot(r * std::cos(rim), r * std::sin(rim) + 0.95);
        return lid + std::hypot(r * (rim - at), 0.05);
      },
      at, 1.5 * kPi);
  const PathResult found = path(block, {0, -0.95, 1}, {r * std::cos(at), r * std::sin(at), 0.95});
  expect_length(found, want, 1e-11);
}

TEST(Edges, ArcAlongAnEdge) {
  // A pillar on the floor: tangents and an arc of its foot.
  const PathResult found = path("min(z, x^2+y^2-1)", {-2, 0.2, 0}, {2, 0.2, 0});
  const double r = std::hypot(2, 0.2);
  const double want = 2 * std::sqrt(r * r - 1) + (kPi - 2 * std::atan2(0.2, 2)) - 2 * std::acos(1 / r);
  expect_length(found, want, 1e-11);
}

TEST(Edges, RoundedBox) {
  // Smooth, but its curvature jumps: flat faces and quarter cylinders unroll into one plane.
  const PathResult found =
      path("sqrt(max(abs(x)-14.8,0)^2+max(abs(y)-5.8,0)^2+max(abs(z)-5.8,0)^2)=0.2", {-15, 0, 5}, {15, 0, -5});
  expect_length(found, 39.75966076935517, 1e-12);
}

TEST(Edges, SymmetryAndTriangle) {
  PathSolver solver(parse_surface(kCan));
  const Eigen::Vector3d a(0.3, -0.4, 1);
  const Eigen::Vector3d b(2 * std::cos(2.0), 2 * std::sin(2.0), -0.3);
  const Eigen::Vector3d c(-0.8, 0.9, -1);
  const double ab = solver.solve(a, b).length;
  const double bc = solver.solve(b, c).length;
  const double ac = solver.solve(a, c).length;
  EXPECT_NEAR(solver.solve(b, a).length, ab, 1e-12);
  EXPECT_LE(ac, ab + bc + 1e-12);
  EXPECT_LE(ab, ac + bc + 1e-12);
}

// Against exact unfolding by a program of its own (2026-11-30). The first was missed since rows of faces were told
// apart half-way only, the second since a stop turned to and fro next to a corner.
TEST(Edges, ConvexPolyhedra) {
  const std::string eleven =
      "max(-0.640887*x+0.306784*y+0.330722*z,0.00635944*x-0.356162*y-0.825888*z,-0.357378*x-0.594345*y+0.0598131*z,"
      "0.755228*x-0.453534*y+0.943045*z,-0.717053*x-0.32281*y+0.340128*z,0.40446*x+0.892437*y+0.573849*z,"
      "-0.707996*x-0.122936*y+0.437403*z,0.486308*x+0.737886*y+0.329391*z,0.293655*x-0.0847668*y-0.896129*z,"
      "0.358436*x-0.0691003*y+0.777754*z,0.601499*x+0.165124*y+0.69562*z)=1";
  expect_length(path(eleven, {-0.3399444994259985, -1.0766286869737844, -0.7491422931892372},
                     {-0.38600369585266525, 0.356305603265655, 1.460563233817568}),
                3.441414707783354, 1e-12);
  const std::string eight =
      "max(-0.400967*x+0.931491*y-0.072435*z,-0.696457*x+0.319912*y-0.233413*z,"
      "0.591563*x+0.168309*y+0.0968963*z,-0.0577057*x+1.09277*y-0.134365*z,"
      "0.127812*x-0.471182*y-0.727301*z,0.450284*x-0.648274*y+0.845697*z,0.141887*x-0.0813132*y-0.677999*z,"
      "-0.292858*x+0.921696*y-0.31556*z)=1";
  expect_length(path(eight, {1.3435928182043917, 0.10870918539890416, -1.2067881184745282},
                     {-1.4575718259774115, 0.1586829229281384, 0.2823350560788684}),
                3.8595636564495925, 1e-12);
}

// Over a lid with a hole that grows in the path's way.
TEST(Edges, ASmallerDomainNeverShortens) {
  FormulaOptions options;
  options.dim = 3;
  double before = 0;
  for (const char* radius : {"0.1", "0.4", "0.9"}) {
    options.domain = {std::string("(x-0.2)^2+y^2>=") + radius};
    const PathResult found = shortest_path(parse_surface(kCan, options), Eigen::Vector3d(-1.5, 0.1, 1),
                                           Eigen::Vector3d(2 * std::cos(0.1), 2 * std::sin(0.1), 0.4));
    EXPECT_EQ(found.status, Status::ok) << found.message;
    EXPECT_GT(found.length, before + 1e-6);
    before = found.length;
  }
}

TEST(Edges, ManyPairsAreThoseAloneOnAnyThreads) {
  Points from(3, 20);
  Points to(3, 20);
  for (Index j = 0; j < 20; ++j) {
    const double a = 0.7 * static_cast<double>(j);
    from.col(j) << 2 * std::cos(a), 2 * std::sin(a), 0.09 * static_cast<double>(j) - 0.9;
    to.col(j) << std::cos(2 * a), std::sin(3 * a), j % 2 == 0 ? 1 : -1;
  }
  const auto solve = [&](Index threads) {
    Context context;
    context.threads = static_cast<int>(threads);
    return PathSolver(parse_surface(kCan), {}, context).solve_pairs(from, to);
  };
  const std::vector<PathResult> one = solve(1);
  const std::vector<PathResult> two = solve(2);
  PathSolver alone(parse_surface(kCan));
  for (Index j = 0; j < 20; ++j) {
    const auto i = static_cast<std::size_t>(j);
    EXPECT_EQ(one[i].status, Status::ok) << one[i].message;
    EXPECT_EQ(one[i].length, two[i].length);
    EXPECT_EQ(one[i].points, two[i].points);
    EXPECT_EQ(one[i].length, alone.solve(from.col(j), to.col(j)).length);
  }
}

}  // namespace
}  // namespace taut
