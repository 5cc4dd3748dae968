// Closed forms beside those of test_edges and test_borders: shapes whose shortest paths a ruler and a compass give.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;

PathResult path(const std::string& formula, const std::vector<std::string>& domain, const Eigen::Vector3d& p,
                const Eigen::Vector3d& q) {
  FormulaOptions options;
  options.dim = 3;
  options.domain = domain;
  return shortest_path(parse_surface(formula, options), p, q);
}

void expect_length(const PathResult& found, double length) {
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_NEAR(found.length, length, 1e-11 * length);
}

// Out of the bore and down the sphere, in one plane.
TEST(EdgeTruth, BoredSphere) {
  const double polar = kPi / 3;
  expect_length(path("max(x^2+y^2+z^2-4, 1-x^2-y^2)", {}, {1, 0, 0}, {2 * std::sin(polar), 0, 2 * std::cos(polar)}),
                std::sqrt(3.0) + 2 * (polar - kPi / 6));
}

// A capsule is smooth, with curvature that jumps where its caps begin; a cylinder with flat caps has rims there.
TEST(EdgeTruth, CapsuleAgainstACylinderWithCaps) {
  const std::string capsule = "sqrt(x^2+y^2+max(abs(z)-1,0)^2)=1";
  expect_length(path(capsule, {}, {1, 0, 0.5}, {0, 0, 2}), 0.5 + kPi / 2);
  expect_length(path("max(x^2+y^2-1, abs(z)-1)", {}, {1, 0, 0.5}, {0, 0, 1}), 0.5 + 1);
  // Aslant: over the point of the seam at azimuth a that makes the sum of helix and great circle least.
  const double polar = 1.0;
  const double azimuth = 1.2;
  const auto length = [&](double a) { return std::hypot(a, 1.0) + std::acos(std::sin(polar) * std::cos(azimuth - a)); };
  double low = 0;
  double high = azimuth;
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3;
    (length(low + third) < length(high - third) ? high : low) =
        length(low + third) < length(high - third) ? high - third : low + third;
  }
  expect_length(path(capsule, {}, {1, 0, 0},
                     {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), 1 + std::cos(polar)}),
                length((low + high) / 2));
}

// Tangent, arc, the straight line over both discs, arc, tangent.
TEST(EdgeTruth, PlaneWithTwoHoles) {
  const PathResult found = path("z=0", {"(x+1.5)^2+y^2>=1", "(x-1.5)^2+y^2>=1"}, {-4, 0, 0}, {4, 0, 0});
  expect_length(found, 2 * std::sqrt(5.25) + 2 * std::asin(0.4) + 3);
  EXPECT_FALSE(found.unique);  // above them and below
}

// A corridor of discs that reach through its walls on alternate sides: under the first, over the second, under the
// third, with inner tangents from one to the next.
TEST(EdgeTruth, CorridorOfDiscs) {
  std::vector<std::string> domain;
  for (const char* disc : {"(x+3)^2+(y-0.5)^2>=1", "x^2+(y+0.5)^2>=1", "(x-3)^2+(y-0.5)^2>=1", "y<=1", "y>=-1"}) {
    domain.emplace_back(disc);
  }
  const double first = std::sqrt(9.25 - 1);                // tangent from the end
  const double between = std::sqrt(10.0 - 4);              // inner tangent of discs that are (3, 1) apart
  const double slope = std::atan2(1.0, 3.0);               // of the line between neighbours
  const double turn = std::acos(2 / std::sqrt(10.0));      // between that line and the radius to the tangent
  const double end_turn = std::acos(1 / std::sqrt(9.25));  // the same for the end
  const double end_slope = std::atan2(0.5, 3.0);
  // Angles of the touching points of the first disc, about its centre.
  const double begin = kPi + end_slope + end_turn;
  const double leave = 2 * kPi - slope - turn;
  // Of the second: both of its tangents are inner ones.
  const double middle = kPi - 2 * (slope + turn);
  expect_length(path("z=0", domain, {-6, 0, 0}, {6, 0, 0}), 2 * first + 2 * between + 2 * (leave - begin) + middle);
}

// The half plane y >= 0 with half a disc cut out of it.
TEST(EdgeTruth, ABayInAHalfPlane) {
  const PathResult found = path("z=0", {"y>=0", "x^2+y^2>=1"}, {-2, 0.5, 0}, {2, 0.5, 0});
  const double away = std::sqrt(4.25);
  expect_length(found, 2 * std::sqrt(3.25) + kPi - 2 * std::atan(0.25) - 2 * std::acos(1 / away));
  EXPECT_TRUE(found.unique);
}

// Next to a wall across the tube the way leads once round the torus, along its inner equator.
TEST(EdgeTruth, TorusWithAWall) {
  const double a = 0.5;
  expect_length(path("(sqrt(x^2+y^2)-2)^2+z^2=1", {"max(abs(y)-0.1,-x)>=0"}, {std::cos(a), std::sin(a), 0},
                     {std::cos(a), -std::sin(a), 0}),
                2 * kPi - 2 * a);
}

// Round a window, over its two upper corners: straight lines on the unrolled cylinder.
TEST(EdgeTruth, CylinderWithAWindow) {
  const double a = 1.2;
  const double half = std::asin(0.6);
  expect_length(path("x^2+y^2=1", {"max(abs(z)-0.5,abs(y)-0.6,-x)>=0"}, {std::cos(a), std::sin(a), 0.1},
                     {std::cos(a), -std::sin(a), 0.1}),
                2 * std::hypot(a - half, 0.4) + 2 * half);
}

// A fillet of radius r over an edge of 90 degrees takes (2 - pi/2) r out of the unfolded faces: the answer falls in
// proportion to r from that of sharp edges.
TEST(EdgeTruth, FilletsTendToSharpEdges) {
  for (const double r : {0.4, 0.1, 0.02}) {
    const auto side = [&](double half) { return std::to_string(half - r); };
    const std::string rounded = "sqrt(max(abs(x)-" + side(15) + ",0)^2+max(abs(y)-" + side(6) + ",0)^2+max(abs(z)-" +
                                side(6) + ",0)^2)=" + std::to_string(r);
    const double less = 2 * (2 - kPi / 2) * r;
    expect_length(path(rounded, {}, {-15, 0, 5}, {15, 0, -5}), std::hypot(32 - less, 24 - less));
  }
}

// Of 2026-12-01: the kink of max(1-x, x-3) at x = 2, in a box that plays no part there, hid all edges of the upper
// riser, and 4.35 was returned. Up the first riser, then over faces whose unfolding gives the truth (exact polyhedral
// distances of the mesh).
TEST(EdgeTruth, StairsOfBoxesWithKinksInTheirFaces) {
  const std::string stairs = "min(max(-x,x-3,-y,y-2,-z,z-1),max(1-x,x-3,-y,y-2,-z,z-2),max(2-x,x-3,-y,y-2,-z,z-3))";
  expect_length(
      path(stairs, {}, {0.16400583037382271, 2, 0.21166120042392308}, {2.4248672554128707, 1.2645479331308882, 3}),
      4.166760988659469);
  expect_length(
      path(stairs, {}, {2.5996484466484011, 0.056989597463230561, 3}, {0.4294313919467726, 2, 0.776168119040611}),
      4.539667176009818);
}

// Of 2026-12-01: the rim of the upper disc's hole pushes a path off the disc, but the wall inside pulls it. So no
// shortest path runs along the rim, though the two curvatures sum to less than zero: it cuts the rim twice.
TEST(EdgeTruth, LeavesARimOnTheSideThatPulls) {
  const std::string ring = "max((sqrt(x^2+y^2)-2)^2+z^2-0.5, abs(z)-0.4)";
  const Eigen::Vector3d p(0.42435476632975055, -2.3149004153483768, 0.4);
  const Eigen::Vector3d q(1.4801835212514307, 1.9910663719377044, 0.4);
  const double rim = 2 - std::sqrt(0.5 - 0.16);
  const auto tangent = [&](const Eigen::Vector3d& x) { return std::sqrt(x.head<2>().squaredNorm() - rim * rim); };
  const auto turn = [&](const Eigen::Vector3d& x) { return std::atan2(x.y(), x.x()); };
  const double arc = turn(q) - turn(p) - std::atan(tangent(p) / rim) - std::atan(tangent(q) / rim);
  const double along_the_rim = tangent(p) + tangent(q) + rim * arc;
  const PathResult there = path(ring, {}, p, q);
  EXPECT_LT(there.length, along_the_rim - 5e-3);
  expect_length(path(ring, {}, q, p), there.length);
}

/// The least value of a function that falls and then rises between two places.
double least_between(double low, double high, const std::function<double(double)>& value) {
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3;
    (value(low + third) < value(high - third) ? high : low) =
        value(low + third) < value(high - third) ? high - third : low + third;
  }
  return value((low + high) / 2);
}

// The room of the spider and the fly: a wall of 12 by 12, a room of 30. From wall to wall over one, two or three of the
// four sides between them, whichever side comes first and whichever way round: 20 nets.
TEST(EdgeTruth, EveryNetOfABoxFromWallToWall) {
  constexpr double kHalf = 6;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> side(-kHalf, kHalf);
  const Surface room = parse_surface("max(abs(x)-15, abs(y)-6, abs(z)-6)=0", {.dim = 3});
  PathSolver solver(room);
  for (int pair = 0; pair < 60; ++pair) {
    const Eigen::Vector2d start(side(random), side(random));
    const Eigen::Vector2d end(side(random), side(random));
    double least = std::numeric_limits<double>::infinity();
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Eigen::Rotation2D<double> turn(quarter * kPi / 2);
      for (const double mirror : {1.0, -1.0}) {
        const Eigen::Vector2d p = turn * start.cwiseProduct(Eigen::Vector2d(mirror, 1));
        const Eigen::Vector2d q = turn * end.cwiseProduct(Eigen::Vector2d(mirror, 1));
        const double up = 30 + kHalf - p.y();
        least = std::min(least, std::hypot(up + kHalf - q.y(), p.x() - q.x()));
        least = std::min(least, std::hypot(up + kHalf - q.x(), 2 * kHalf - p.x() - q.y()));
        least = std::min(least, std::hypot(up + kHalf + q.y(), 4 * kHalf - p.x() - q.x()));
      }
    }
    expect_length(solver.solve(Eigen::Vector3d(-15, start.x(), start.y()), Eigen::Vector3d(15, end.x(), end.y())),
                  least);
  }
}

struct Disc {
  Eigen::Vector2d centre;
  double radius;
};

/// The shortest way from p to q in the plane round discs that do not meet: over all tangents from the ends, all
/// tangents of two discs, and the arcs between them.
double way_round(const std::vector<Disc>& discs, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  struct Touch {
    Eigen::Vector2d x;
    int disc;      // -1: an end
    double angle;  // about its centre
  };
  std::vector<Touch> touches{{p, -1, 0}, {q, -1, 0}};
  std::vector<std::array<std::size_t, 2>> lines{{0, 1}};
  const auto touch = [&](int disc, double angle) {
    const Disc& d = discs[static_cast<std::size_t>(disc)];
    touches.push_back({d.centre + d.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)), disc, angle});
    return touches.size() - 1;
  };
  const auto n = static_cast<int>(discs.size());
  for (int i = 0; i < n; ++i) {
    const Disc& one = discs[static_cast<std::size_t>(i)];
    for (const std::size_t end : {0U, 1U}) {
      const Eigen::Vector2d away = touches[end].x - one.centre;
      for (const double sign : {1.0, -1.0}) {
        const double angle = std::atan2(away.y(), away.x()) + sign * std::acos(one.radius / away.norm());
        lines.push_back({end, touch(i, angle)});
      }
    }
    for (int j = 0; j < i; ++j) {
      const Disc& two = discs[static_cast<std::size_t>(j)];
      const Eigen::Vector2d away = two.centre - one.centre;
      for (const double sign : {1.0, -1.0}) {
        for (const bool inner : {false, true}) {
          const double lean = std::acos((one.radius + (inner ? 1 : -1) * two.radius) / away.norm());
          const double angle = std::atan2(away.y(), away.x()) + sign * lean;
          const std::size_t first = touch(i, angle);
          lines.push_back({first, touch(j, inner ? angle + kPi : angle)});
        }
      }
    }
  }
  struct Step {
    std::size_t to;
    double length;
  };
  std::vector<std::vector<Step>> steps(touches.size());
  const auto join = [&](std::size_t a, std::size_t b, double length) {
    steps[a].push_back({b, length});
    steps[b].push_back({a, length});
  };
  for (const auto& [a, b] : lines) {
    const Eigen::Vector2d along = touches[b].x - touches[a].x;
    const bool free = std::none_of(discs.begin(), discs.end(), [&](const Disc& d) {
      const double t = std::clamp((d.centre - touches[a].x).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (touches[a].x + t * along - d.centre).norm() < d.radius - 1e-12;
    });
    if (free) join(a, b, along.norm());
  }
  for (std::size_t a = 2; a < touches.size(); ++a) {
    for (std::size_t b = 2; b < a; ++b) {
      if (touches[a].disc != touches[b].disc) continue;
      const double turn = std::abs(std::remainder(touches[a].angle - touches[b].angle, 2 * kPi));
      join(a, b, discs[static_cast<std::size_t>(touches[a].disc)].radius * turn);
    }
  }
  std::vector<double> length(touches.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  length[0] = 0;
  front.emplace(0, 0);
  while (!front.empty()) {
    const auto [so_far, at] = front.top();
    front.pop();
    if (so_far > length[at]) continue;
    for (const Step& step : steps[at]) {
      if (so_far + step.length >= length[step.to]) continue;
      length[step.to] = so_far + step.length;
      front.emplace(length[step.to], step.to);
    }
  }
  return length[1];
}

TEST(EdgeTruth, PlaneWithFiveHoles) {
  const std::vector<Disc> discs = {
      {{-2, 0}, 0.7}, {{2, 0.5}, 0.8}, {{0, 2}, 0.6}, {{0.3, -1.8}, 0.7}, {{-2.5, 2.5}, 0.5}};
  FormulaOptions options;
  options.dim = 3;
  for (const Disc& d : discs) {
    options.domain.push_back("(x-(" + std::to_string(d.centre.x()) + "))^2+(y-(" + std::to_string(d.centre.y()) +
                             "))^2>=" + std::to_string(d.radius * d.radius));
  }
  PathSolver solver(parse_surface("z=0", options));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> side(-4, 4);
  const auto free_point = [&] {
    for (;;) {
      const Eigen::Vector2d x(side(random), side(random));
      const auto holds = [&](const Disc& d) { return (x - d.centre).norm() < d.radius; };
      if (std::none_of(discs.begin(), discs.end(), holds)) return x;
    }
  };
  for (int pair = 0; pair < 40; ++pair) {
    const Eigen::Vector2d p = free_point();
    const Eigen::Vector2d q = free_point();
    expect_length(solver.solve(Eigen::Vector3d(p.x(), p.y(), 0), Eigen::Vector3d(q.x(), q.y(), 0)),
                  way_round(discs, p, q));
  }
}

// Of 2026-12-01: of two ways round the tip of a cone, which differ by half a per cent, the longer one was returned;
// from near the tip all ways in between are hardly longer. The cone unrolled gives the truth.
TEST(EdgeTruth, BothWaysRoundTheTipOfACone) {
  const Eigen::Vector3d tip(0, 0, 1.2);
  const Eigen::Vector3d p(0.15900945387232773, -0.070186631840376101, 0.98273658805110398);
  const Eigen::Vector3d q(-1.0311688350171111, 0.41398401693940734, -0.18895865477513052);
  const double first = (p - tip).norm();
  const double second = (q - tip).norm();
  const double turn = std::abs(std::remainder(std::atan2(q.y(), q.x()) - std::atan2(p.y(), p.x()), 2 * kPi));
  const double unrolled = turn * std::sin(std::atan(0.8));
  expect_length(path("max(sqrt(x^2+y^2)-0.8*(1.2-z), -z-0.3)", {}, p, q),
                std::sqrt(first * first + second * second - 2 * first * second * std::cos(unrolled)));
}

// Of 2026-12-01: up a wall and over a lid there may be two places at one rim where the path could cross, with hardly a
// rise between them: both are looked at.
TEST(EdgeTruth, TwoPlacesToCrossOneRim) {
  const double r = 0.8;
  const Eigen::Vector3d p(-0.45623228788390552, 0.65715454764630288, -0.1243007549375586);
  const Eigen::Vector3d q(0.039320662560394008, -0.69905919541413841, r);
  const double start = std::atan2(p.y(), p.x());
  const auto length = [&](double turn) {  // crossing the rim so far round
    const Eigen::Vector3d x(r * std::cos(start + turn), r * std::sin(start + turn), r);
    return std::hypot(r * turn, r - p.z()) + (q - x).norm();
  };
  double least = std::numeric_limits<double>::infinity();
  constexpr int kParts = 60;
  for (int i = -kParts; i < kParts; ++i) {
    least = std::min(least, least_between(kPi * i / kParts, kPi * (i + 2) / kParts, length));
  }
  expect_length(path("min(x^2+y^2+(z-1.1)^2-0.25, max(x^2+y^2-0.64, abs(z)-0.8))", {}, p, q), least);
}

// Two pipes that meet: round the upper one the path crosses onto it, comes down to the seam along it, follows the seam
// where neither pipe pulls, and leaves it along it. By the two tangents and the one crossing on the unrolled pipes,
// solved by bisection and golden section to all digits.
TEST(EdgeTruth, FollowsASeamOnlyWhereNeitherPipePulls) {
  const std::string tee = "min(max(y^2+z^2-0.36, abs(x)-1.5), max((x-0.1)^2+y^2-0.16, z-1.3, -z))";
  const PathResult found = path(tee, {}, {0.53017053804856329, 0.4493034243153442, 0.3976511447217343},
                                {-0.24793741741232889, -0.30057740600831295, 0.51928144873210491});
  expect_length(found, 1.40286831371109);
  int followed = 0;
  for (const PathPiece& piece : found.pieces) followed += piece.kind == PathPiece::Kind::edge ? 1 : 0;
  EXPECT_EQ(followed, 1);
}

}  // namespace
}  // namespace taut
