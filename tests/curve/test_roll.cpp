#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "taut/cells/surface_cells.hpp"
#include "taut/curve/flow.hpp"
#include "taut/march/descend.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/projection.hpp"
#include "taut/surface/rbf.hpp"

// The roll (Figure 3 of the paper): a sheet rolled up along the spiral r = t, turns 2 pi apart, known only by samples.
// Unrolled it is a strip, so distances are those of the plane.

namespace taut {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInnerAngle = 1.5 * kPi;
constexpr double kOuterAngle = 4.5 * kPi;
constexpr double kHeight = 8;

/// Arc length of the spiral r = t from its centre.
double arc_length(double t) { return 0.5 * (t * std::sqrt(1 + t * t) + std::asinh(t)); }

Eigen::Vector3d on_roll(double t, double height) { return {t * std::cos(t), height, t * std::sin(t)}; }

Surface fitted_roll(Index num_samples) {
  PointCloud cloud;
  cloud.points.resize(3, num_samples);
  cloud.normals.resize(3, num_samples);
  for (Index i = 0; i < num_samples; ++i) {
    // Evenly along the strip, heights by the golden ratio.
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(num_samples);
    const double s = arc_length(kInnerAngle) + u * (arc_length(kOuterAngle) - arc_length(kInnerAngle));
    double t = std::sqrt(2 * s);
    for (int step = 0; step < 20; ++step) t -= (arc_length(t) - s) / std::sqrt(1 + t * t);
    cloud.points.col(i) = on_roll(t, kHeight * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0));
    cloud.normals.col(i) =
        Eigen::Vector3d(t * std::cos(t) + std::sin(t), 0, t * std::sin(t) - std::cos(t)).normalized();
  }
  return make_surface(std::make_shared<const RbfModel>(fit_rbf(cloud)));
}

TEST(Roll, GeodesicsGoRoundAndDoNotJumpBetweenTheTurns) {
  const Surface roll = fitted_roll(700);
  struct Pair {
    double from_angle, from_height, to_angle, to_height;
  };
  const Pair pairs[] = {
      {2 * kPi, 4, 4 * kPi, 4},          // face to face on neighbouring turns: 6.3 apart through the air
      {1.6 * kPi, 1.6, 4.3 * kPi, 6.4},  // over all turns
      {3 * kPi, 2.4, 3.2 * kPi, 4.8},    // on one turn
  };
  for (const Pair& pair : pairs) {
    const double truth =
        std::hypot(arc_length(pair.to_angle) - arc_length(pair.from_angle), pair.to_height - pair.from_height);
    const Vector p = project_to_surface(roll, on_roll(pair.from_angle, pair.from_height)).point;
    const Vector q = project_to_surface(roll, on_roll(pair.to_angle, pair.to_height)).point;
    double lengths[2];
    for (int i = 0; i < 2; ++i) {
      const double cell = 0.5 / (1 << i);
      SurfaceCells cells = SurfaceCells::lazy(roll, p, cell);
      MarchOptions march_options;
      march_options.target = q;
      const DistanceField field = march(roll, cells, p, march_options);
      FlowOptions options;
      options.cell = cell;
      const FlowResult path = correct_flow(roll, descend(roll, cells, field, q), options);
      ASSERT_EQ(path.status, Status::ok) << path.reason << ", cell " << cell;
      EXPECT_NEAR(path.length, truth, 0.01 * truth) << "cell " << cell;
      EXPECT_NEAR(path.length, truth, 2e-4 * truth) << "what fit and polyline are good for";
      EXPECT_TRUE(path.locally_shortest);
      lengths[i] = path.length;
    }
    EXPECT_NEAR(lengths[0], lengths[1], 1e-6 * truth) << "cells of 0.5 and 0.25";
  }
}

}  // namespace
}  // namespace taut
