#include "taut/query/tangent_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/query/distance.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

struct Row {
  std::string surface;
  double length = 0;
  Vector p, q, v, w;
  double m12 = 0, M12 = 0, M21 = 0;
};

const std::map<std::string, std::string>& formulas() {
  static const std::map<std::string, std::string> all{
      {"oblate_c0.5", "x^2+y^2+z^2/0.5^2-1"},
      {"oblate_c0.1", "x^2+y^2+z^2/0.1^2-1"},
      {"prolate_c2", "x^2+y^2+z^2/2^2-1"},
      {"triaxial_3_2_1", "x^2/9+y^2/4+z^2-1"},
      {"triaxial_sqrt2_1_isqrt2", "x^2/2+y^2+2*z^2-1"},
      {"torus_1_0.4", "(x^2+y^2+z^2+1-0.4^2)^2-4*(x^2+y^2)"},
      {"torus_1_0.8", "(x^2+y^2+z^2+1-0.8^2)^2-4*(x^2+y^2)"},
      {"tanglecube", "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8"},
      {"genus2", "2*y*(y^2-3*x^2)*(1-z^2)+(x^2+y^2)^2-(9*z^2-1)*(1-z^2)"},
      {"decocube", "((x^2+y^2-0.64)^2+(z^2-1)^2)*((y^2+z^2-0.64)^2+(x^2-1)^2)*((z^2+x^2-0.64)^2+(y^2-1)^2)-0.02"},
      {"hyperellipsoid_R5", "x1^2/1.5^2+x2^2/1.2^2+x3^2/1^2+x4^2/0.9^2+x5^2/0.8^2-1"},
      {"clifford_1_0.6", "x1^2+x2^2-1; x3^2+x4^2-0.36"}};
  return all;
}

std::vector<Row> rows() {
  std::ifstream file(TAUT_TEST_DATA "/reference_logs.txt");
  std::vector<Row> result;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    Row row;
    words >> row.surface >> row.length;
    const Index d = parse_surface(formulas().at(row.surface)).dim();
    for (Vector* vector : {&row.p, &row.q, &row.v, &row.w}) {
      vector->resize(d);
      for (double& entry : *vector) words >> entry;
    }
    std::string number;
    for (double* value : {&row.m12, &row.M12, &row.M21}) {
      words >> number;
      *value = std::stod(number);
    }
    result.push_back(row);
  }
  return result;
}

/// Directions at both ends and the Jacobi fields against software that shares nothing with this one.
TEST(LogMap, AgreesWithReferences) {
  std::map<std::string, PathSolver> solvers;
  for (const auto& [name, formula] : formulas()) solvers.emplace(name, PathSolver(parse_surface(formula)));
  const std::vector<Row> all = rows();
  EXPECT_GT(all.size(), 40U);
  for (const Row& row : all) {
    const LogMapResult found = log_map(solvers.at(row.surface), row.p, row.q);
    SCOPED_TRACE(row.surface + " " + std::to_string(row.length));
    ASSERT_EQ(found.status, Status::ok) << found.message;
    // Points are rounded to doubles.
    constexpr double kRounding = 4e-16;
    EXPECT_NEAR(found.length, row.length, 1e-12 * row.length + kRounding);
    EXPECT_LT((found.direction - row.v).norm(), 1e-10 + kRounding / row.length);
    EXPECT_LT((found.arrival - row.w).norm(), 1e-10 + kRounding / row.length);
    EXPECT_LT(found.miss, 1e-10);
    if (!found.scales || std::isnan(row.m12)) continue;
    const double size = std::max({1.0, std::abs(row.M12), std::abs(row.M21), std::abs(row.m12)});
    EXPECT_NEAR(found.scales->m12, row.m12, 1e-10 * size);
    EXPECT_NEAR(found.scales->M12, row.M12, 1e-10 * size);
    EXPECT_NEAR(found.scales->M21, row.M21, 1e-10 * size);
  }
}

TEST(LogMap, UndoesTheExponentialMap) {
  for (const std::string formula : {"x^2+2y^2+4z^2=1", "x1^2+x2^2+x3^2+2*x4^2+x5^2=1", "x1^2+x2^2=1; x3^2+2*x4^2=1"}) {
    const Surface surface = parse_surface(formula);
    const Index d = surface.dim();
    const Vector p =
        surface.codim() == 1 ? Vector(Vector::Unit(d, 0)) : Vector(Vector::Unit(d, 0) + Vector::Unit(d, 2));
    Vector towards = Vector::Constant(d, 0.7);
    towards(d - 1) = -1;
    const double length = 0.4;  // well within the injectivity radius
    const ExponentialResult ray = exponential_map(surface, p, towards, length);
    const Vector start = exponential_map(surface, p, towards, 0).direction;
    const LogMapResult found = log_map(surface, p, ray.point);
    ASSERT_EQ(found.status, Status::ok);
    EXPECT_LT((found.velocity() - length * start).norm(), 1e-12) << formula;
    EXPECT_LT((found.arrival - ray.direction).norm(), 1e-11) << formula;
  }
}

/// The fan's directions, and those of corrected paths in more dimensions, at many targets at once.
TEST(LogMap, IsWhatAFieldSaysOfEachTarget) {
  for (const std::string formula : {"x^2+2y^2+4z^2=1", "x1^2+x2^2+2*x3^2+3*x4^2=1"}) {
    const Surface surface = parse_surface(formula);
    const Index d = surface.dim();
    const Vector p = Vector::Unit(d, 0);
    Points targets(d, 4);
    for (Index j = 0; j < 4; ++j) {
      Vector v = Vector::Constant(d, 0.3);
      v(d - 1) = -0.2 - 0.1 * static_cast<double>(j);
      targets.col(j) = exponential_map(surface, p, v, 0.3 + 0.2 * static_cast<double>(j)).point;
    }
    const Distances field = DistanceSolver(surface, p).at(targets);
    PathSolver solver(surface);
    for (Index j = 0; j < 4; ++j) {
      const LogMapResult one = log_map(solver, p, targets.col(j));
      EXPECT_LT((field.departure.col(j) - one.direction).norm(), 2e-9) << formula;
      EXPECT_LT((field.arrival.col(j) - one.arrival).norm(), 1e-7) << formula;
    }
  }
}

/// dL/dR and dL/dr of a torus against differences of lengths, and of two equations.
TEST(LogMap, KnowsHowTheLengthChangesWithParameters) {
  const std::string torus = "(x^2+y^2+z^2+R^2-r^2)^2 = 4R^2(x^2+y^2)";
  const std::string product = "x1^2+x2^2=R^2; x3^2+2x4^2=r^2";
  for (const std::string& formula : {torus, product}) {
    const bool first = formula == torus;
    Vector p;
    Vector q;
    const auto ask = [&](double R, double r) {
      return log_map(parse_surface(formula, {.parameters = {{"R", R}, {"r", r}}}), p, q);
    };
    // Ends on the surface: they move along its normals.
    p = first ? Vector(Eigen::Vector3d(1.35, 0.1, 0.1)) : Vector(Eigen::Vector4d(1, 0.1, 0.4, 0));
    q = first ? Vector(Eigen::Vector3d(0.5, 1.1, 0.3)) : Vector(Eigen::Vector4d(0.2, 0.9, 0.1, 0.25));
    const LogMapResult rough = ask(1, 0.4);
    p = rough.from;
    q = rough.to;
    const LogMapResult at = ask(1, 0.4);
    const auto extended =
        parse_function(formula, {.variables = first ? std::vector<std::string>{"x", "y", "z", "R", "r"}
                                                    : std::vector<std::string>{"x1", "x2", "x3", "x4", "R", "r"}});
    const Vector slope = length_derivative(*extended, at.curve, Eigen::Vector2d(1, 0.4));
    for (const Index c : {0, 1}) {
      const auto length = [&](double h) { return ask(c == 0 ? 1 + h : 1, c == 1 ? 0.4 + h : 0.4).length; };
      const auto difference = [&](double h) { return (length(h) - length(-h)) / (2 * h); };
      const double h = 4e-3;  // Ridders: order 6
      const double twice = (4 * difference(h / 2) - difference(h)) / 3;
      const double fine = (4 * difference(h / 4) - difference(h / 2)) / 3;
      EXPECT_NEAR(slope(c), (16 * fine - twice) / 15, 1e-10) << formula << " " << c;
    }
  }
  // L = R times an angle.
  const Surface sphere = parse_surface("x^2+y^2+z^2=R^2", {.parameters = {{"R", 2}}});
  const LogMapResult quarter = log_map(sphere, Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(0, 2, 0));
  const auto extended = parse_function("x^2+y^2+z^2=R^2", {.variables = {"x", "y", "z", "R"}});
  EXPECT_NEAR(length_derivative(*extended, quarter.curve, Vector(Vector::Constant(1, 2)))(0), std::numbers::pi / 2,
              1e-12);
}

/// Closed forms to 1e-12, which differences of lengths do not reach: along meridians L is an integral over the angle.
TEST(LogMap, KnowsDerivativesToRounding) {
  // On a torus's meridian L = r (b - a), and R moves it as a whole.
  const auto on_torus = [](double u) { return Vector(Eigen::Vector3d(1 + 0.4 * std::cos(u), 0, 0.4 * std::sin(u))); };
  const std::string torus = "(x^2+y^2+z^2+R^2-r^2)^2 = 4R^2(x^2+y^2)";
  const LogMapResult round =
      log_map(parse_surface(torus, {.parameters = {{"R", 1}, {"r", 0.4}}}), on_torus(0.3), on_torus(1.9));
  const auto of_torus = parse_function(torus, {.variables = {"x", "y", "z", "R", "r"}});
  const Vector by_radii = length_derivative(*of_torus, round.curve, Eigen::Vector2d(1, 0.4));
  EXPECT_NEAR(by_radii(1), 1.6, 1e-12);
  // Its ends move along the normals, by cos u of them: the rest of R's motion is along the curve.
  EXPECT_NEAR(by_radii(0), std::sin(1.9) - std::sin(0.3), 1e-12);

  // On an ellipse (cos t, c sin t): d/dc of the integral of |x'|, less what ends at fixed t move along the curve.
  const double c = 0.5;
  const auto on_ellipse = [&](double t) { return Vector(Eigen::Vector3d(std::cos(t), 0, c * std::sin(t))); };
  const double begin = 0.2;
  const double end = 1.3;
  const std::string ellipsoid = "x^2+y^2+z^2/c^2 = 1";
  const LogMapResult meridian =
      log_map(parse_surface(ellipsoid, {.parameters = {{"c", c}}}), on_ellipse(begin), on_ellipse(end));
  const auto of_ellipsoid = parse_function(ellipsoid, {.variables = {"x", "y", "z", "c"}});
  const auto speed = [&](double t) { return std::hypot(std::sin(t), c * std::cos(t)); };
  const auto along = [&](double t) { return c * std::cos(t) * std::sin(t) / speed(t); };  // of (0, 0, sin t)
  const int pieces = 2000;                                                                // Simpson's rule
  double integral = 0;
  double length = 0;
  for (int i = 0; i <= pieces; ++i) {
    const double t = begin + (end - begin) * i / pieces;
    const double weight = (i == 0 || i == pieces ? 1 : (i % 2 == 1 ? 4 : 2)) * (end - begin) / (3 * pieces);
    integral += weight * c * std::cos(t) * std::cos(t) / speed(t);
    length += weight * speed(t);
  }
  EXPECT_NEAR(meridian.length, length, 1e-12);
  EXPECT_NEAR(length_derivative(*of_ellipsoid, meridian.curve, Vector(Vector::Constant(1, c)))(0),
              integral - (along(end) - along(begin)), 1e-12);
  // By the ends it is the tangents there.
  const auto tangent = [&](double t) {
    return Eigen::Vector3d(Eigen::Vector3d(-std::sin(t), 0, c * std::cos(t)) / speed(t));
  };
  EXPECT_LT((Eigen::Vector3d(meridian.direction) - tangent(begin)).norm(), 1e-12);
  EXPECT_LT((Eigen::Vector3d(meridian.arrival) - tangent(end)).norm(), 1e-12);
}

TEST(LogMap, SpeaksOfPointsWithoutAWay) {
  const Surface sphere = test::unit_sphere();
  const Vector p = Eigen::Vector3d(1, 0, 0);
  const LogMapResult same = log_map(sphere, p, p);
  EXPECT_EQ(same.status, Status::ok);
  EXPECT_EQ(same.velocity(), Vector(Vector::Zero(3)));
  EXPECT_EQ(same.miss, 0);
  const LogMapResult opposite = log_map(sphere, p, -p);
  EXPECT_FALSE(opposite.unique);
  EXPECT_NEAR(opposite.length, std::numbers::pi, 1e-9);
  const Surface two = parse_surface("((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)");
  const LogMapResult apart = log_map(two, Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(-3, 0, 0));
  EXPECT_EQ(apart.status, Status::disconnected);
  EXPECT_FALSE(apart.direction.allFinite());
  EXPECT_THROW((void)log_map(sphere, p, Vector::Zero(2)), InvalidArgument);
}

}  // namespace
}  // namespace taut
