#include <gtest/gtest.h>

#include <memory>

#include "support/rolled_sheet.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/fit.hpp"

// The roll (Figure 3 of the paper) through the whole of `shortest_path`: the path between two turns goes round and does
// not jump from turn to turn, whatever corrects it and whatever cells it starts from. The truth is the unrolled
// strip's.

namespace taut {
namespace {

using test::kRollPairs;
using test::RolledSheet;
using test::RollPair;

Surface fitted(const PointCloud& cloud) { return make_surface(std::make_shared<const RbfModel>(fit_rbf(cloud))); }

/// Default cells and smaller ones: both within `accuracy` of the truth, and within `agreement` of each other. `out`
/// says how far from the mid-surface the pair stands.
void expect_going_round(const Surface& roll, const RollPair& pair, CorrectionMethod method, double accuracy,
                        double out = 0, double agreement = 1e-6) {
  const double truth = pair.distance(out);
  double lengths[2];
  for (int i = 0; i < 2; ++i) {
    const double cell = i == 0 ? 0 : 0.5;
    const PathResult path =
        shortest_path(roll, RolledSheet::point(pair.from_angle, pair.from_height, out),
                      RolledSheet::point(pair.to_angle, pair.to_height, out), {.method = method, .cell = cell});
    SCOPED_TRACE("cell " + std::to_string(path.cell) + ", truth " + std::to_string(truth));
    ASSERT_EQ(path.status, Status::ok) << path.message;
    EXPECT_NEAR(path.length, truth, accuracy * truth);
    EXPECT_TRUE(path.locally_shortest);
    lengths[i] = path.length;
  }
  EXPECT_NEAR(lengths[0], lengths[1], agreement * truth);
}

TEST(Roll, NewtonGoesRound) {
  const Surface roll = fitted(RolledSheet{}.cloud(700));
  for (const RollPair& pair : kRollPairs) expect_going_round(roll, pair, CorrectionMethod::newton, 5e-5);
}

TEST(Roll, FlowGoesRound) {
  const Surface roll = fitted(RolledSheet{}.cloud(700));
  for (const RollPair& pair : kRollPairs) expect_going_round(roll, pair, CorrectionMethod::flow, 1e-4);
}

TEST(Roll, NormalsAreFoundBySomeoneWhoWasGivenNone) {
  PointCloud cloud = RolledSheet{}.cloud(700);
  cloud.normals.resize(3, 0);
  const Surface roll = fitted(cloud);
  expect_going_round(roll, kRollPairs[1], CorrectionMethod::newton, 5e-5);
}

TEST(Roll, NoisySamplesDoNotMakeItJump) {
  const Surface roll = fitted(RolledSheet{}.cloud(1000, 0.15));  // a fifth of the spacing: smoothed
  expect_going_round(roll, kRollPairs[0], CorrectionMethod::newton, 0.01);
  expect_going_round(roll, kRollPairs[0], CorrectionMethod::flow, 0.01);
  expect_going_round(roll, kRollPairs[2], CorrectionMethod::newton, 0.01);
}

// The swiss roll of manifold learning: samples at random, 21 high, with noise too mild to be smoothed. The bumps it
// leaves have shortest paths on either side, 7e-5 apart in length: closer than marched distances tell apart.
TEST(Roll, SwissRollWithMildNoiseIsGoneRound) {
  PointCloud cloud = test::roll_cloud(1000);
  test::Uniform uniform(7);
  for (Index i = 0; i < cloud.size(); ++i) cloud.points.col(i) += 0.05 * uniform.normal() * cloud.normals.col(i);
  const Surface roll = fitted(cloud);
  RollPair pair = kRollPairs[1];
  pair.from_height += 6.5;
  pair.to_height += 6.5;
  expect_going_round(roll, pair, CorrectionMethod::newton, 0.01, 0, 2e-4);
}

// Both faces sampled: the path between two points on the face towards the axis stays on that face, which is the shorter
// one. The samples are 0.9 apart on each face and 1 across.
TEST(Roll, ThinSolidSheetIsRolledUpToo) {
  const RolledSheet sheet{.thickness = 1};
  const Surface roll = fitted(sheet.cloud(1600));
  const double out = -sheet.thickness / 2;
  expect_going_round(roll, kRollPairs[0], CorrectionMethod::newton, 5e-4, out);
  expect_going_round(roll, kRollPairs[1], CorrectionMethod::flow, 5e-4, out);
}

// Found on 22 November 2026: neighbours on the other face counted as noise, half a unit of it on exact samples, and the
// faces were smoothed away from them by 0.2.
TEST(Roll, TwoFacesOfAThinSheetAreNotNoise) {
  for (const double thickness : {1.0, 0.6}) {
    const RbfModel model = fit_rbf(RolledSheet{.thickness = thickness}.cloud(1600), {});
    EXPECT_LT(model.report.noise, 0.01 * model.report.spacing);
    EXPECT_EQ(model.report.smoothing, 0);
  }
}

}  // namespace
}  // namespace taut
