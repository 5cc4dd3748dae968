// What must hold on every surface, checked on random ones: distances are a metric, do not feel how the surface is
// written down, and move and scale with it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>

#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr unsigned kSeed = 20;
constexpr int kSurfaces = 6;
/// Default tolerance on both sides of each comparison.
constexpr double kClose = 4e-9;

/// A random closed smooth surface about the origin: an ellipsoid with a dent, F as text in x, y, z.
struct RandomSurface {
  std::string text;
  double a, b, c, dent;

  explicit RandomSurface(std::mt19937& random) {
    std::uniform_real_distribution<double> axis(0.6, 1.4);
    std::uniform_real_distribution<double> depth(-0.15, 0.15);
    a = axis(random);
    b = axis(random);
    c = axis(random);
    dent = depth(random);
    text = with("x", "y", "z");
  }
  /// F with other expressions in the place of x, y and z.
  [[nodiscard]] std::string with(const std::string& x, const std::string& y, const std::string& z) const {
    return fmt::format("({0})^2/{3:.17g}+({1})^2/{4:.17g}+({2})^2/{5:.17g}+({6:.17g})*({0})*({1})*({2})-1", x, y, z,
                       a * a, b * b, c * c, dent);
  }
};

Vector random_point(const Surface& surface, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (;;) {
    const Vector direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const ProjectionResult on = project_to_surface(surface, direction);
    if (on.converged) return on.point;
  }
}

double distance(const Surface& surface, const Vector& p, const Vector& q) {
  const PathResult path = shortest_path(surface, p, q);
  EXPECT_EQ(path.status, Status::ok) << path.message;
  return path.length;
}

class Properties : public testing::TestWithParam<int> {
 protected:
  std::mt19937 random{kSeed + static_cast<unsigned>(GetParam())};
  RandomSurface shape{random};
  Surface surface = parse_surface(shape.text);
  Vector p = random_point(surface, random);
  Vector q = random_point(surface, random);
  double d = distance(surface, p, q);
};

TEST_P(Properties, DistancesAreAMetric) {
  const Vector r = random_point(surface, random);
  EXPECT_NEAR(distance(surface, q, p), d, kClose * d) << shape.text;
  EXPECT_GE(d, (p - q).norm());
  EXPECT_LE(d, (distance(surface, p, r) + distance(surface, r, q)) * (1 + kClose)) << shape.text;
}

TEST_P(Properties, HowTheSurfaceIsWrittenDoesNotMatter) {
  EXPECT_NEAR(distance(parse_surface("3*(" + shape.text + ")"), p, q), d, kClose * d) << shape.text;
  EXPECT_NEAR(distance(parse_surface("-(" + shape.text + ")"), p, q), d, kClose * d) << shape.text;
  EXPECT_NEAR(distance(parse_surface(fmt::format("({0})+({0})^3", shape.text)), p, q), d, kClose * d) << shape.text;
}

TEST_P(Properties, DistancesScaleAndMoveWithTheSurface) {
  constexpr double kScale = 250;
  const std::string larger = shape.with("x/250", "y/250", "z/250");
  EXPECT_NEAR(distance(parse_surface(larger), kScale * p, kScale * q), kScale * d, kClose * kScale * d) << shape.text;

  std::uniform_real_distribution<double> angle(-3, 3);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitZ()))
                                   .toRotationMatrix();
  const Eigen::Vector3d shift(angle(random), angle(random), angle(random));
  const auto back = [&](int row) {  // row of turn^T (X - shift)
    std::string text = "0";
    const char* names[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) text += fmt::format("+({:.17g})*({}-({:.17g}))", turn(i, row), names[i], shift(i));
    return text;
  };
  const Surface moved = parse_surface(shape.with(back(0), back(1), back(2)));
  EXPECT_NEAR(distance(moved, turn * p + shift, turn * q + shift), d, kClose * d) << shape.text;
}

// The same surface in R^4, with w = 0 as a second equation.
TEST_P(Properties, AFlatExtraDimensionDoesNotMatter) {
  Vector p4 = Vector::Zero(4);
  Vector q4 = Vector::Zero(4);
  p4.head(3) = p;
  q4.head(3) = q;
  EXPECT_NEAR(distance(parse_surface(shape.text + "; w"), p4, q4), d, kClose * d) << shape.text;
}

// Map coordinates: the cells' numbers are then beyond single precision. Rounding of F leaves some nine digits.
TEST(FarFromTheOrigin, TheShortestWayIsTheSame) {
  const Eigen::Vector3d shift(1e6, -2e6, 5e5);
  const Surface here = parse_surface("x^10+y^10+z^10=1");
  const Surface there = parse_surface("(x-1000000)^10+(y+2000000)^10+(z-500000)^10=1");
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 6; ++i) {
    const auto point = [&] {
      return project_to_surface(here, Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized())
          .point;
    };
    const Eigen::Vector3d p = point();
    const Eigen::Vector3d q = point();
    const PathResult unmoved = shortest_path(here, p, q);
    const PathResult moved = shortest_path(there, p + shift, q + shift);
    ASSERT_EQ(unmoved.status, Status::ok);
    EXPECT_TRUE(moved.status != Status::ok || moved.doubts.any() ||
                std::abs(moved.length - unmoved.length) < 1e-7 * unmoved.length)
        << moved.length << " for " << unmoved.length;
  }
}

INSTANTIATE_TEST_SUITE_P(RandomSurfaces, Properties, testing::Range(0, kSurfaces));

}  // namespace
}  // namespace taut
