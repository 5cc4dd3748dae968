// Cells as wide as a limb of a fitted surface, which the paper's tables are made with: the path on them may go the
// wrong way round the limb, and no correction brings it back. Then finer cells are looked at, or a doubt is said.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "support/clouds.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

using std::numbers::pi;

/// A tube bent to a U: two straight legs along z, a half circle below, round caps.
struct BentTube {
  static constexpr double kRadius = 0.5;  // of the tube
  static constexpr double kBend = 0.8;    // of its axis in the bend
  static constexpr double kLeg = 2;

  /// On the left leg, by the angle round its axis and the height.
  static Eigen::Vector3d point(double angle, double height) {
    return {-kBend + kRadius * std::cos(angle), kRadius * std::sin(angle), height};
  }
  /// Between two such points that are not so far round that another way is shorter: unrolled.
  static double distance(double from_angle, double from_height, double to_angle, double to_height) {
    return std::hypot(kRadius * std::remainder(to_angle - from_angle, 2 * pi), to_height - from_height);
  }

  /// `n` samples along the tube, and the caps' in proportion, by the golden ratio.
  static PointCloud cloud(Index n) {
    const double length = 2 * kLeg + pi * kBend;
    const auto num_cap = static_cast<Index>(static_cast<double>(n) * 2 * kRadius / length);
    PointCloud cloud = test::empty_cloud(3, n + 2 * num_cap);
    const auto put = [&cloud](Index i, const Eigen::Vector3d& centre, const Eigen::Vector3d& normal) {
      cloud.points.col(i) = centre + kRadius * normal;
      cloud.normals.col(i) = normal;
    };
    const auto turn = [](Index i) { return 2 * pi * std::fmod(static_cast<double>(i) / std::numbers::phi, 1.0); };
    for (Index i = 0; i < n; ++i) {
      const double s = (static_cast<double>(i) + 0.5) / static_cast<double>(n) * length;
      const double bend = std::clamp((s - kLeg) / kBend, 0.0, pi);
      Eigen::Vector3d centre(-kBend * std::cos(bend), 0, -kBend * std::sin(bend));
      centre.z() += std::max(0.0, kLeg - s) + std::max(0.0, s - kLeg - pi * kBend);
      const Eigen::Vector3d inwards(std::cos(bend), 0, std::sin(bend));
      put(i, centre, std::cos(turn(i)) * inwards + std::sin(turn(i)) * Eigen::Vector3d::UnitY());
    }
    for (Index i = 0; i < num_cap; ++i) {
      const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(num_cap);
      const double r = std::sqrt(1 - z * z);
      const Eigen::Vector3d normal(r * std::cos(turn(i)), r * std::sin(turn(i)), z);
      put(n + 2 * i, {-kBend, 0, kLeg}, normal);
      put(n + 2 * i + 1, {kBend, 0, kLeg}, normal);
    }
    return cloud;
  }
};

struct LegPair {
  double from_angle, from_height, to_angle, to_height;
};

// Without the doubt two of these come out 1.6 and 1.1 times too long from such cells, as unique.
TEST(CoarseCells, OnAFittedTubeNoLongerPathIsCalledTheShortest) {
  const Surface tube = make_surface(std::make_shared<const RbfModel>(fit_rbf(BentTube::cloud(600))));
  const LegPair pairs[] = {{0.732, 1.202, -1.503, 0.453}, {-2.397, 1.984, 0.567, 1.940}, {2.8, 0.16, 0.414, 0.149}};
  int closer = 0;
  for (const double cell : {0.6, 0.8, 1.0}) {
    PathSolver solver(tube, {.cell = cell});
    for (const LegPair& pair : pairs) {
      const double truth = BentTube::distance(pair.from_angle, pair.from_height, pair.to_angle, pair.to_height);
      const PathResult path = solver.solve(BentTube::point(pair.from_angle, pair.from_height),
                                           BentTube::point(pair.to_angle, pair.to_height));
      SCOPED_TRACE("cell " + std::to_string(cell) + ", truth " + std::to_string(truth));
      if (path.status != Status::ok) continue;  // said
      if (path.unique) {
        EXPECT_NEAR(path.length, truth, 2e-3 * truth) << path.message;
      }
      closer += path.cell < cell ? 1 : 0;
    }
  }
  EXPECT_GT(closer, 4) << "most are answered on finer cells";
}

}  // namespace
}  // namespace taut
