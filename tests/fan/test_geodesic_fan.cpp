#include "fan/geodesic_fan.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "fan/panel_point.hpp"
#include "support/surfaces.hpp"
#include "surface/simd_dispatch.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using namespace detail;

using std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

GeodesicFan fan_from(const Surface& surface, const Vector& source, const FanOptions& options) {
  return {surface, source, Vector::Zero(1), options};
}

/// The whole fan from one point.
GeodesicFan whole_fan(const Surface& surface, const Vector& source, const FanOptions& options) {
  GeodesicFan fan = fan_from(surface, source, options);
  fan.extend(kInfinity);
  return fan;
}

Points random_points(const Surface& surface, Index n, double extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-extent, extent);
  Points points(3, n);
  for (Index j = 0; j < n;) {
    points.col(j) << uniform(random), uniform(random), uniform(random);
    const ProjectionResult projected = project_to_surface(surface, points.col(j), {.max_distance = 0.3});
    if (projected.converged) points.col(j++) = projected.point;
  }
  return points;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(GeodesicFan, GivesTheAngleOnTheUnitSphereEverywhere) {
  const Surface sphere = test::unit_sphere();
  const Eigen::Vector3d p = Eigen::Vector3d(1, 2, -2) / 3;
  const GeodesicFan fan = whole_fan(sphere, p, {.max_panel = 0.5});
  EXPECT_TRUE(fan.finished());
  EXPECT_EQ(fan.reach(), kInfinity);
  EXPECT_FALSE(fan.broken());
  Points targets = random_points(sphere, 2000, 1, 1);
  targets.col(0) = -p;  // all rays meet there
  targets.col(1) = p;
  const Eigen::Vector3d side = p.unitOrthogonal();
  for (Index j = 2; j < 40; ++j) {  // beside the source, and beside the antipode, ever nearer
    const double apart = std::pow(0.5, static_cast<double>(j / 2));
    targets.col(j) = (j % 2 == 0 ? 1 : -1) * (std::cos(apart) * p + std::sin(apart) * side);
  }
  const std::vector<FanHit> hits = fan.locate(targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    const double angle = angle_between(p, targets.col(j));
    EXPECT_NEAR(hits[static_cast<std::size_t>(j)].distance, angle, 1e-11 * angle + 4e-16) << targets.col(j);
  }
}

/// Lengths on the flat surfaces are those of the plane they roll out to.
TEST(GeodesicFan, UnrollsTheCylinderBothWaysRound) {
  const Surface cylinder = parse_surface("x^2+y^2=1", {.dim = 3});
  GeodesicFan fan = fan_from(cylinder, Eigen::Vector3d(1, 0, 0), {.max_panel = 0.5});
  fan.extend(4);
  EXPECT_GE(fan.reach(), 4);
  for (const double turn : {0.3, 2.0, pi, 3.5, 6.0}) {
    for (const double height : {-1.5, 0.0, 2.0}) {
      const double round = std::min(turn, 2 * pi - turn);
      const FanHit hit = fan.locate(Vector(Eigen::Vector3d(std::cos(turn), std::sin(turn), height))).front();
      EXPECT_NEAR(hit.distance, std::hypot(round, height), 1e-11) << turn << " " << height;
    }
  }
}

/// Opposite points have two shortest ways, and each turn more makes another two.
TEST(GeodesicFan, NamesAllWaysToAPoint) {
  const Surface cylinder = parse_surface("x^2+y^2=1", {.dim = 3});
  GeodesicFan fan = fan_from(cylinder, Eigen::Vector3d(1, 0, 0), {.max_panel = 0.5});
  fan.extend(4);
  const Eigen::Vector3d q(-1, 0, 1);
  const std::vector<FanHit> ways = fan.ways(q, 3.5);
  ASSERT_EQ(ways.size(), 2U);
  const double sideways = pi / std::hypot(pi, 1);
  for (const FanHit& way : ways) {
    EXPECT_NEAR(way.distance, std::hypot(pi, 1), 1e-11);
    EXPECT_NEAR(std::abs(way.departure.y()), sideways, 1e-10);
  }
  EXPECT_NEAR(ways[0].departure.y(), -ways[1].departure.y(), 1e-10);
  EXPECT_TRUE(fan.ways(q, 3.2).empty());
}

/// Points at or near the cut locus, where a longer geodesic is easily taken for the shortest.
TEST(GeodesicFan, IsTheGlobalMinimumAtTheCutLocusOfTheReferences) {
  std::ifstream file(TAUT_TEST_DATA "/near_cut_locus.txt");
  const auto numbers = [](std::istream& line) {
    std::string field;
    std::getline(line, field, ';');
    std::istringstream words(field);
    std::vector<double> values;
    for (double value = 0; words >> value;) values.push_back(value);
    return Vector(Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size())));
  };
  std::map<std::string, int> asked;
  for (std::string text; std::getline(file, text);) {
    if (text.starts_with('#')) continue;
    std::istringstream line(text);
    std::string formula;
    std::getline(line, formula, ';');
    if (++asked[formula] > 4) continue;  // a fan each
    const Surface surface = parse_surface(formula);
    const double length = numbers(line)(0);
    const Vector p = project_to_surface(surface, numbers(line)).point;
    const Vector q = project_to_surface(surface, numbers(line)).point;
    GeodesicFan fan = fan_from(surface, p, {.max_panel = 0.4});
    fan.extend(1.001 * length);
    const FanHit hit = fan.locate(q).front();
    EXPECT_NEAR(hit.distance, length, 1e-10 * length) << text;
    EXPECT_LE(std::abs(hit.distance - length), hit.error + 1e-13 * length) << text;
    EXPECT_GE(fan.reach(), length) << text;
  }
  EXPECT_GE(asked.size(), 12U);
}

TEST(GeodesicFan, DirectionsAreThoseOfTheGeodesic) {
  const Surface torus = test::torus(1, 0.4);
  const Vector p = Eigen::Vector3d(1.4, 0, 0);
  const GeodesicFan fan = whole_fan(torus, p, {.max_panel = 0.3});
  const Points targets = random_points(torus, 60, 1.4, 3);
  const std::vector<FanHit> hits = fan.locate(targets);
  for (Index j = 0; j < targets.cols(); ++j) {
    const FanHit& hit = hits[static_cast<std::size_t>(j)];
    const ExponentialResult ray = exponential_map(torus, p, hit.departure, hit.distance);
    const double grown = 1e-9 * ray.amplification;
    EXPECT_LT((ray.point - targets.col(j)).norm(), grown);
    // A direction is a derivative of the patch: a digit or two less than the point.
    EXPECT_LT((ray.direction - hit.arrival).norm(), 30 * grown);
  }
}

TEST(GeodesicFan, SeveralSourcesGiveTheLeastOfTheSingleOnesPlusTheirValues) {
  const Surface surface = test::ellipsoid(1.2, 1, 0.7);
  const Points sources = random_points(surface, 3, 1, 5);
  const Vector values = Eigen::Vector3d(0, 0.3, 9);  // the third is farther from itself than from the others
  GeodesicFan joint(surface, sources, values, {.max_panel = 0.4});
  joint.extend(kInfinity);
  const Points targets = random_points(surface, 300, 1.2, 6);
  const std::vector<FanHit> hits = joint.locate(targets);
  std::vector<std::vector<FanHit>> single;
  Index patches = 0;
  for (Index s = 0; s < 3; ++s) {
    const GeodesicFan fan = whole_fan(surface, sources.col(s), {.max_panel = 0.4});
    patches += fan.num_patches();
    single.push_back(fan.locate(targets));
  }
  for (std::size_t j = 0; j < hits.size(); ++j) {
    const double first = single[0][j].distance;
    const double second = single[1][j].distance + 0.3;
    EXPECT_NEAR(hits[j].distance, std::min(first, second), 1e-10);
    if (std::abs(first - second) > 1e-9) {
      EXPECT_EQ(hits[j].source, first < second ? 0 : 1);
    }
  }
  EXPECT_LT(joint.num_patches(), patches);  // each is followed in its own part only
}

TEST(GeodesicFan, IsSymmetric) {
  const Surface surface = test::tangle_cube();
  const Points points = random_points(surface, 4, 2.4, 8);
  Eigen::Matrix4d distance;
  for (Index i = 0; i < 4; ++i) {
    const GeodesicFan fan = whole_fan(surface, points.col(i), {.max_panel = 0.6});
    const std::vector<FanHit> hits = fan.locate(points);
    for (Index j = 0; j < 4; ++j) distance(i, j) = hits[static_cast<std::size_t>(j)].distance;
  }
  EXPECT_LT((distance - distance.transpose()).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_EQ(distance.diagonal().cwiseAbs().maxCoeff(), 0);
}

/// A tighter tolerance gives a smaller error: what is asked for steers what comes out.
TEST(GeodesicFan, MeetsEveryTolerance) {
  const Surface surface = test::ellipsoid(3, 2, 1);
  const Vector p = Eigen::Vector3d(0, 2, 0);
  const Points targets = random_points(surface, 200, 2, 9);
  const std::vector<FanHit> best = whole_fan(surface, p, {.tolerance = 1e-12, .max_panel = 0.5}).locate(targets);
  Index last = 0;
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    const GeodesicFan fan = whole_fan(surface, p, {.tolerance = tolerance, .max_panel = 1.5});
    const std::vector<FanHit> hits = fan.locate(targets);
    for (std::size_t j = 0; j < hits.size(); ++j) {
      EXPECT_NEAR(hits[j].distance, best[j].distance, tolerance * best[j].distance);
    }
    EXPECT_GT(fan.num_patches(), last);
    last = fan.num_patches();
  }
}

TEST(GeodesicFan, NumberOfThreadsChangesNothing) {
  const Surface surface = test::torus(1, 0.3);
  const Points targets = random_points(surface, 600, 1.3, 11);
  std::vector<std::vector<FanHit>> hits;
  for (const int threads : {1, 3}) {
    Context context;
    context.threads = threads;
    GeodesicFan fan = fan_from(surface, Eigen::Vector3d(0, 1.3, 0), {.max_panel = 0.4});
    fan.extend(1);  // in parts
    fan.extend(kInfinity, context);
    hits.push_back(fan.locate(targets, context));
  }
  for (std::size_t j = 0; j < hits[0].size(); ++j) {
    EXPECT_EQ(hits[0][j].distance, hits[1][j].distance);
    EXPECT_EQ(hits[0][j].departure, hits[1][j].departure);
  }
}

TEST(GeodesicFan, DoesNotReachAnotherComponent) {
  const Surface two = parse_surface("((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)");
  const GeodesicFan fan = whole_fan(two, Eigen::Vector3d(3, 0, 0), {.max_panel = 0.5});
  EXPECT_EQ(fan.reach(), kInfinity);
  EXPECT_EQ(fan.locate(Vector(Eigen::Vector3d(-1, 0, 0))).front().distance, kInfinity);
  EXPECT_NEAR(fan.locate(Vector(Eigen::Vector3d(1, 0, 0))).front().distance, pi, 1e-11);
}

/// What cannot be followed bounds what is claimed, and nothing is made up beyond.
TEST(GeodesicFan, SaysHowFarItIsCompleteWhereThereAreCreases) {
  const Surface cube = parse_surface("max(abs(x),abs(y),abs(z))=1");
  GeodesicFan fan = fan_from(cube, Eigen::Vector3d(0.2, 0.1, 1), {.max_panel = 0.25});
  fan.extend(3);
  EXPECT_TRUE(fan.broken());
  const auto bound = [&](double x, double y) { return fan.bound(Eigen::Vector3d(x, y, 1)); };
  EXPECT_NEAR(bound(1, 0.1), 0.8, 2e-3);  // on the nearest edge
  EXPECT_LE(bound(1, 0.1), 0.8);
  // To the edge x = 1 and back: by its mirror image.
  EXPECT_NEAR(bound(0.2, 0.1), 1.6, 1e-2);
  EXPECT_LE(bound(0.2, 0.1), 1.6);
  EXPECT_NEAR(fan.locate(Vector(Eigen::Vector3d(-0.4, -0.3, 1))).front().distance, std::hypot(0.6, 0.4), 1e-12);
}

TEST(GeodesicFan, StopsAtItsBudgetAndSaysSo) {
  GeodesicFan fan = fan_from(test::torus(), Eigen::Vector3d(1.4, 0, 0), {.max_panel = 0.1, .max_patches = 100});
  fan.extend(kInfinity);
  EXPECT_TRUE(fan.finished());
  EXPECT_LT(fan.reach(), 2);
  EXPECT_GT(fan.reach(), 0.1);
}

TEST(GeodesicFan, CanBeCancelled) {
  std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  GeodesicFan fan = fan_from(test::unit_sphere(), Eigen::Vector3d(1, 0, 0), {.max_panel = 0.5});
  EXPECT_THROW(fan.extend(1, context), Cancelled);
}

TEST(GeodesicFan, RefusesWhatItCannotDo) {
  const Vector p = Eigen::Vector3d(1, 0, 0);
  EXPECT_THROW(fan_from(test::unit_sphere(4), Vector::Unit(4, 0), {.max_panel = 1}), InvalidArgument);
  EXPECT_THROW(fan_from(test::unit_sphere(), p, {}), InvalidArgument);  // no panel size
  EXPECT_THROW(fan_from(test::unit_sphere(), p, {.tolerance = 0, .max_panel = 1}), InvalidArgument);
  EXPECT_THROW(GeodesicFan(test::unit_sphere(), p, Vector::Zero(2), {.max_panel = 1}), InvalidArgument);
  EXPECT_THROW(fan_from(parse_surface("x^2+y^2=z^2"), Vector::Zero(3), {.max_panel = 1}), SingularPoint);
}

/// A panel's sums are those of the series' definition, and the same on every instruction set.
TEST(PanelPoint, SumsTheSeriesInAnyLanes) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  detail::ExpPatch patch{};
  for (Index n = 0; n < patch.series.cols(); ++n) {
    for (Index r = 0; r < patch.series.rows(); ++r) {
      patch.series(r, n) = normal(random) * std::pow(0.3, static_cast<double>(n + r / 3));
    }
  }
  const auto best = detail::instruction_set();
  for (const auto& [alpha, beta] : {std::pair{0.3, -0.7}, std::pair{-1.0, 1.0}, std::pair{0.999, 0.01}}) {
    detail::use_instruction_set(detail::InstructionSet::baseline);
    const detail::PanelPoint p = detail::panel_point(patch, alpha, beta);
    const double a = std::acos(alpha);
    const double b = std::acos(beta);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (Index n = 0; n < patch.series.cols(); ++n) {
      for (Index m = 0; 3 * m < patch.series.rows(); ++m) {
        const double weight = std::cos(static_cast<double>(n) * b) * std::cos(static_cast<double>(m) * a);
        x += weight * patch.series.col(n).segment<3>(3 * m);
      }
    }
    EXPECT_LT((p.x - x).norm(), 1e-13);
    constexpr double kStep = 1e-5;
    const Eigen::Vector3d across =
        (detail::panel_point(patch, alpha + kStep, beta).x - detail::panel_point(patch, alpha - kStep, beta).x);
    const Eigen::Vector3d along =
        (detail::panel_point(patch, alpha, beta + kStep).x - detail::panel_point(patch, alpha, beta - kStep).x);
    EXPECT_LT((p.across - across / (2 * kStep)).norm(), 1e-7);
    EXPECT_LT((p.along - along / (2 * kStep)).norm(), 1e-7);
    for (const auto set :
         {detail::InstructionSet::sse4, detail::InstructionSet::avx2, detail::InstructionSet::avx512}) {
      if (!detail::has_instruction_set(set)) continue;
      detail::use_instruction_set(set);
      const detail::PanelPoint same = detail::panel_point(patch, alpha, beta);
      EXPECT_EQ(same.x, p.x);
      EXPECT_EQ(same.across, p.across);
      EXPECT_EQ(same.along, p.along);
    }
    detail::use_instruction_set(detail::InstructionSet::baseline);
    const detail::PanelPoint sketch = detail::panel_sketch(patch, alpha, beta);
    EXPECT_LT((sketch.x - p.x).norm(), detail::sketch_error(patch));
    EXPECT_GT((sketch.x - p.x).norm(), 0);
    for (const auto set :
         {detail::InstructionSet::sse4, detail::InstructionSet::avx2, detail::InstructionSet::avx512}) {
      if (!detail::has_instruction_set(set)) continue;
      detail::use_instruction_set(set);
      EXPECT_EQ(detail::panel_sketch(patch, alpha, beta).x, sketch.x);
    }
  }
  detail::use_instruction_set(best);
}

}  // namespace
}  // namespace taut
