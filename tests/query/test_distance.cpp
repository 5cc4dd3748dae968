#include "taut/query/distance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Points random_points(const Surface& surface, Index n, double extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-extent, extent);
  Points points(surface.dim(), n);
  for (Index j = 0; j < n;) {
    for (double& x : points.col(j)) x = uniform(random);
    const ProjectionResult projected = project_to_surface(surface, points.col(j), {.max_distance = extent / 5});
    if (projected.converged && surface.inside_domain(projected.point)(0)) points.col(j++) = projected.point;
  }
  return points;
}

/// Two ways to the same number that share no code: all geodesics from the source, and a corrected path to each target.
TEST(DistanceSolver, AgreesWithCorrectedPaths) {
  for (const std::string formula : {"(x^2+y^2+z^2+1-0.1^2)^2-4*(x^2+y^2)", "x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8",
                                    "2y*(y^2-3x^2)*(1-z^2)+(x^2+y^2)^2-(9z^2-1)*(1-z^2)", "x^2+y^2+25z^2=1"}) {
    const Surface surface = parse_surface(formula);
    const double extent = formula.starts_with("x^4") ? 2.4 : 1.1;
    const Points points = random_points(surface, 9, extent, 1);
    const Points targets = points.rightCols(8);
    DistanceSolver solver(surface, points.leftCols(1));
    const Distances found = solver.at(targets);
    const std::vector<PathResult> paths = PathSolver(surface).solve_from(points.col(0), targets);
    for (Index j = 0; j < targets.cols(); ++j) {
      const std::size_t i = static_cast<std::size_t>(j);
      ASSERT_EQ(found.status[i], Status::ok) << formula;
      EXPECT_EQ(found.proof[i], DistanceProof::fan) << formula;
      EXPECT_LE(found.distance(j), paths[i].length * (1 + 1e-9)) << formula;  // a path is never shorter
      EXPECT_NEAR(found.distance(j), paths[i].length, 1e-9 * paths[i].length) << formula;
      EXPECT_GE(found.distance(j), (targets.col(j) - points.col(0)).norm());
    }
  }
}

/// From all corners of a mesh of the surface the distance is 1-Lipschitz along every edge, and nowhere NaN.
TEST(DistanceSolver, IsOneLipschitz) {
  const Surface surface = test::torus(1, 0.4);
  Points sources(3, 2);
  sources << 1.4, -0.6, 0, 0, 0, 0;
  DistanceSolver solver(surface, sources);
  const Points targets = random_points(surface, 400, 1.4, 2);
  const Distances u = solver.at(targets);
  EXPECT_TRUE(u.distance.allFinite());
  for (Index i = 0; i < targets.cols(); i += 7) {
    const Distances between = DistanceSolver(surface, targets.col(i)).at(targets);
    for (Index j = 0; j < targets.cols(); ++j) {
      EXPECT_LE(std::abs(u.distance(i) - u.distance(j)), between.distance(j) + 1e-10);
    }
  }
}

TEST(DistanceSolver, KeepsItsFanForTheNextQuestion) {
  DistanceSolver solver(test::unit_sphere(), Vector(Eigen::Vector3d(1, 0, 0)));
  const auto at_angle = [&](double angle) {
    return solver.at(Vector(Eigen::Vector3d(std::cos(angle), std::sin(angle), 0))).distance(0);
  };
  EXPECT_NEAR(at_angle(0.3), 0.3, 1e-12);
  const Index few = solver.num_patches();
  EXPECT_NEAR(at_angle(3.1), 3.1, 1e-12);
  const Index all = solver.num_patches();
  EXPECT_LT(few, all);
  EXPECT_NEAR(at_angle(2), 2, 1e-12);
  EXPECT_EQ(solver.num_patches(), all);
}

TEST(DistanceSolver, ProvesThatPointsLieApart) {
  const Surface two = parse_surface("((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)");
  Points targets(3, 2);
  targets << 1, -1, 0, 0, 0, 0;
  const Distances found = DistanceSolver(two, Vector(Eigen::Vector3d(3, 0, 0))).at(targets);
  EXPECT_EQ(found.status[0], Status::ok);
  EXPECT_NEAR(found.distance(0), pi, 1e-11);
  EXPECT_EQ(found.status[1], Status::disconnected);
  EXPECT_EQ(found.distance(1), kInfinity);
  EXPECT_TRUE(found.message.contains(1));
}

TEST(DistanceSolver, SpeaksOfEachBadTargetAndAnswersTheOthers) {
  Points targets(3, 3);
  targets << 0, std::numeric_limits<double>::quiet_NaN(), 9, 1, 0, 9, 0, 0, 9;
  const Distances found = DistanceSolver(test::unit_sphere(), Vector(Eigen::Vector3d(1, 0, 0))).at(targets);
  EXPECT_NEAR(found.distance(0), pi / 2, 1e-12);
  for (const Index j : {1, 2}) {
    EXPECT_NE(found.status[static_cast<std::size_t>(j)], Status::ok);
    EXPECT_EQ(found.distance(j), kInfinity);
    EXPECT_TRUE(found.message.contains(j));
  }
}

TEST(DistanceSolver, LeavesOutWhatIsFartherThanAsked) {
  Points targets(3, 2);
  targets << 0.8, 0, 0.6, 1, 0, 0;
  const Distances found =
      DistanceSolver(test::unit_sphere(), Vector(Eigen::Vector3d(1, 0, 0)), {}, {.max_distance = 1}).at(targets);
  EXPECT_NEAR(found.distance(0), std::atan2(0.6, 0.8), 1e-12);
  EXPECT_EQ(found.distance(1), kInfinity);
  EXPECT_EQ(found.status[1], Status::ok);
}

/// Beyond a crease rays are not followed: a corrected path to each target takes over, or says that it cannot.
TEST(DistanceSolver, FallsBackOnPathsInMoreDimensionsAndInsideDomains) {
  const Surface sphere = test::unit_sphere(4);
  const Points points = random_points(sphere, 4, 1, 3);
  const Distances on_sphere = DistanceSolver(sphere, points.col(0)).at(points);
  for (Index j = 0; j < 4; ++j) {
    const double chord = (points.col(j) - points.col(0)).norm();
    EXPECT_NEAR(on_sphere.distance(j), 2 * std::asin(std::min(1.0, chord / 2)), 1e-9);
  }
  // Two equations: a flat torus rolls out to the plane.
  const Surface torus = parse_surface("x1^2+x2^2=1; x3^2+x4^2=0.36");
  const auto place = [](double a, double b) {
    return Vector(Eigen::Vector4d(std::cos(a), std::sin(a), 0.6 * std::cos(b), 0.6 * std::sin(b)));
  };
  Points angles(2, 4);
  angles << 0.3, 2, -1.5, -3, 0.5, -1.4, 2.6, 3;
  Points around(4, 4);
  for (Index j = 0; j < 4; ++j) around.col(j) = place(angles(0, j), angles(1, j));
  const Distances on_torus = DistanceSolver(torus, place(0, 0)).at(around);
  for (Index j = 0; j < 4; ++j) {
    EXPECT_NEAR(on_torus.distance(j), std::hypot(angles(0, j), 0.6 * angles(1, j)), 1e-9) << j;
    EXPECT_NEAR(std::abs(on_torus.departure(1, j)), std::abs(angles(0, j)) / on_torus.distance(j), 1e-9) << j;
  }
  const Surface half = parse_surface("x^2+y^2+z^2=1", {.domain = {"z >= 0"}});
  const Distances on_half =
      DistanceSolver(half, Vector(Eigen::Vector3d(0.8, 0, 0.6))).at(Vector(Eigen::Vector3d(0, 0.8, 0.6)));
  EXPECT_NEAR(on_half.distance(0), std::acos(0.36), 1e-9);
  EXPECT_EQ(on_half.proof[0], DistanceProof::fan) << "the shortest way of all stays inside";
}

/// A ray that leaves the domain is no way: round the hole it is tangents and part of the rim.
TEST(DistanceSolver, DoesNotCutAcrossBorders) {
  const Surface pierced = parse_surface("x^2+y^2+z^2=1", {.domain = {"x <= 0.9"}});
  const Eigen::Vector3d p(0.8, 0.6, 0);
  DistanceSolver solver(pierced, Vector(p));
  Points targets(3, 3);
  targets << 0.8, 0.8, -0.6, -0.6, 0, -0.8, 0, 0.6, 0;
  const Distances u = solver.at(targets);
  const double rim = std::acos(0.9);
  // A point at cos(angle) = c from the middle of the hole: how far its tangent point, and round the hole to it.
  const auto tangent = [&](double c) { return std::acos(c / 0.9); };
  const auto beside = [&](double c) { return std::acos(std::tan(rim) / std::tan(std::acos(c))); };
  for (const Index j : {0, 2}) {  // opposite, seen from the middle of the hole
    const std::size_t i = static_cast<std::size_t>(j);
    const double c = targets(0, j);
    EXPECT_NE(u.proof[i], DistanceProof::fan);
    EXPECT_EQ(u.status[i], Status::ok);
    EXPECT_NEAR(u.distance(j), tangent(0.8) + tangent(c) + std::sin(rim) * (pi - beside(0.8) - beside(c)), 1e-9);
  }
  EXPECT_EQ(u.status[1], Status::ok);  // free of the hole
  EXPECT_NEAR(u.distance(1), std::acos(p.dot(targets.col(1))), 1e-9);
}

/// From an arc of the equator of the sphere, and round a spherical triangle: closed forms for both sides, the corners
/// and the ends.
TEST(DistanceSolver, MeasuresFromCurves) {
  const Surface sphere = test::unit_sphere();
  DistanceSolver solver(sphere, Vector(Eigen::Vector3d(1, 0, 0)));
  Points arc(3, 3);
  arc << 1, std::sqrt(0.5), 0, 0, std::sqrt(0.5), 1, 0, 0, 0;
  solver.set_curves({arc});
  const Points targets = random_points(sphere, 300, 1, 7);
  const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  const auto from_arc = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& q) {
    const Eigen::Vector3d pole = a.cross(b).normalized();
    const Eigen::Vector3d foot = (q - pole * pole.dot(q)).normalized();
    const bool inside = a.cross(foot).dot(pole) > 0 && foot.cross(b).dot(pole) > 0;
    return inside ? std::abs(std::asin(pole.dot(q))) : std::min(angle(a, q), angle(b, q));
  };
  Distances u = solver.at(targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    ASSERT_EQ(u.proof[i], DistanceProof::fan) << u.message[j];
    EXPECT_NEAR(u.distance(j), from_arc(arc.col(0), arc.col(2), targets.col(j)), 1e-10);
    EXPECT_EQ(u.source[i], 0);
    EXPECT_NEAR(angle(u.foot.col(j), targets.col(j)), u.distance(j), 1e-9);
  }
  EXPECT_NEAR(solver.at(arc).distance.maxCoeff(), 0, 1e-13);

  const Points corners = (Points(3, 4) << 1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0).finished();
  const Points other = (Points(3, 2) << -1, 0, 0, -1, 0, 0).finished();
  solver.set_curves({corners, other});
  u = solver.at(targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    double triangle = kInfinity;
    for (Index c = 0; c < 3; ++c) {
      triangle = std::min(triangle, from_arc(corners.col(c), corners.col(c + 1), targets.col(j)));
    }
    const double second = from_arc(other.col(0), other.col(1), targets.col(j));
    EXPECT_NEAR(u.distance(j), std::min(triangle, second), 1e-10);
    if (std::abs(triangle - second) > 1e-9) {
      EXPECT_EQ(u.source[i], triangle < second ? 0 : 1);
    }
  }
}

/// A curve of many points close together, on a torus: never above the distance from its points, and 1-Lipschitz.
TEST(DistanceSolver, MeasuresFromDenseCurves) {
  const Surface torus = test::torus(1, 0.4);
  constexpr Index kPoints = 60;
  Points curve(3, kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    const double t = 2 * pi * static_cast<double>(i) / (kPoints - 1);
    const double theta = 0.8 * std::sin(2 * t);
    curve.col(i) << (1 + 0.4 * std::cos(theta)) * std::cos(t), (1 + 0.4 * std::cos(theta)) * std::sin(t),
        0.4 * std::sin(theta);
  }
  curve.col(kPoints - 1) = curve.col(0);
  DistanceSolver solver(torus, curve.col(0));
  const Points targets = random_points(torus, 200, 1.4, 8);
  solver.set_sources(curve);
  const Distances from_points = solver.at(targets);
  solver.set_curves({curve});
  const Distances from_curve = solver.at(targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    ASSERT_EQ(from_curve.proof[static_cast<std::size_t>(j)], DistanceProof::fan);
    EXPECT_LE(from_curve.distance(j), from_points.distance(j) + 1e-9);
    EXPECT_GE(from_curve.distance(j), from_points.distance(j) - 0.1) << "points lie at most 0.19 apart";
    // The ray at its foot stands at a right angle to the curve, or leaves a corner.
    const Distances at_foot = solver.at(from_curve.foot.col(j));
    EXPECT_LT(at_foot.distance(0), 1e-9);
  }
}

/// Where no fan is there, paths end on the curve: closed forms, each curve straight when it is unrolled. Feet are at
/// right angles, at corners or at ends.
void expect_feet(const Surface& surface, const Points& curve, const Points& targets, const Points& feet,
                 const Vector& truth) {
  DistanceSolver solver(surface, curve.col(0));
  EXPECT_FALSE(solver.has_fan());
  solver.set_curves({curve});
  const Distances u = solver.at(targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    ASSERT_EQ(u.status[i], Status::ok) << u.message.at(j);
    EXPECT_EQ(u.proof[i], DistanceProof::path);
    EXPECT_EQ(u.source[i], 0);
    EXPECT_NEAR(u.distance(j), truth(j), 1e-11 + u.error(j));
    EXPECT_LT(u.error(j), 1e-9);
    EXPECT_LT((u.foot.col(j) - feet.col(j)).norm(), 1e-6);
  }
}

TEST(DistanceSolver, MeasuresFromACurveOnTheThreeSphere) {
  Points arc = Points::Zero(4, 3);
  arc.topRows(2) << 1, std::sqrt(0.5), 0, 0, std::sqrt(0.5), 1;
  const Points targets = random_points(test::unit_sphere(4), 4, 1, 7);
  Points feet = Points::Zero(4, 4);
  Vector truth(4);
  for (Index j = 0; j < 4; ++j) {
    const double rho = std::hypot(targets(0, j), targets(1, j));
    const bool inside = targets(0, j) > 0 && targets(1, j) > 0;
    if (inside) {
      feet.col(j).head(2) = targets.col(j).head(2) / rho;
    } else {
      feet(targets(0, j) > targets(1, j) ? 0 : 1, j) = 1;
    }
    truth(j) = std::acos(feet.col(j).dot(targets.col(j)));
  }
  expect_feet(test::unit_sphere(4), arc, targets, feet, truth);
}

TEST(DistanceSolver, MeasuresFromALineOnACylinderInFourDimensions) {
  const auto place = [](double angle, double z) { return Eigen::Vector4d(std::cos(angle), std::sin(angle), z, 0); };
  Points line(4, 2);
  line << place(0, -1), place(0, 1);
  Points targets(4, 4);
  targets << place(2.5, 0.3), place(-1, 1.4), place(0.4, -1.3), place(-3, -0.9);
  Points feet(4, 4);
  feet << place(0, 0.3), place(0, 1), place(0, -1), place(0, -0.9);
  const Vector truth = Eigen::Vector4d(2.5, std::hypot(1, 0.4), std::hypot(0.4, 0.3), 3);
  expect_feet(parse_surface("x1^2+x2^2=1; x4=0*x3"), line, targets, feet, truth);
}

TEST(DistanceSolver, MeasuresFromASegmentOverTheEdgesOfACube) {
  const Points segment = (Points(3, 2) << -0.5, 0.5, 0, 0, 1, 1).finished();
  const Points targets = (Points(3, 4) << 1, 0.3, 0.1, -0.9, 0.2, 1, 0.7, 0.3, 0.3, 0.9, 1, 1).finished();
  const Points feet = (Points(3, 4) << 0.5, 0.3, 0.1, -0.5, 0, 0, 0, 0, 1, 1, 1, 1).finished();
  const Vector truth = Eigen::Vector4d(std::hypot(1.2, 0.2), 1.1, 0.7, 0.5);
  expect_feet(parse_surface("max(abs(x),abs(y),abs(z))=1"), segment, targets, feet, truth);
}

TEST(DistanceSolver, RefusesWrongCurves) {
  DistanceSolver solver(test::unit_sphere(), Vector(Eigen::Vector3d(1, 0, 0)));
  EXPECT_THROW(solver.set_curves({}), InvalidArgument);
  EXPECT_THROW(solver.set_curves({Points(Points::Identity(3, 1))}), InvalidArgument);
  EXPECT_THROW(solver.set_curves({Points(Vector(Eigen::Vector3d(1, 0, 0)).replicate(1, 2))}), InvalidArgument);
  DistanceSolver many(test::unit_sphere(4), Vector(Vector::Unit(4, 0)));
  EXPECT_THROW(many.set_curves({Points(Points::Identity(3, 2))}), InvalidArgument);
  DistanceSolver cube(parse_surface("max(abs(x),abs(y),abs(z))=1"), Vector(Eigen::Vector3d(0, 0, 1)));
  const Points over_an_edge = (Points(3, 2) << 0, 1, 0, 0, 1, 0).finished();
  EXPECT_THROW(cube.set_curves({over_an_edge}), InvalidArgument);
}

TEST(DistanceSolver, RefusesWrongRequests) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(1, 0, 0);
  EXPECT_THROW(DistanceSolver(sphere, Points(3, 0)), InvalidArgument);
  EXPECT_THROW(DistanceSolver(sphere, Vector(Eigen::Vector2d(1, 0))), InvalidArgument);
  EXPECT_THROW(DistanceSolver(sphere, Vector(9 * p)), InvalidArgument);
  EXPECT_THROW(DistanceSolver(sphere, p, Vector::Zero(2)), InvalidArgument);
  EXPECT_THROW(DistanceSolver(sphere, p, {}, {.tolerance = 1}), InvalidArgument);
  EXPECT_THROW(DistanceSolver(sphere, p, {}, {.max_distance = 0}), InvalidArgument);
  DistanceSolver solver(sphere, p);
  EXPECT_THROW((void)solver.at(Points::Zero(2, 1)), InvalidArgument);
}

}  // namespace
}  // namespace taut
