// A scan of the repository's own through the whole of the paper: Algorithm II, fast marching, projection, curvature
// flow.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "taut/curve/newton.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

TEST(ExampleScan, ThePapersChainComesToTheGeodesicsOfNewtonsMethod) {
  PointCloud cloud = read_point_cloud(TAUT_TEST_DATA "/../../examples/data/bunny.ply");
  cloud.faces.resize(3, 0);
  const Points samples = cloud.points;
  const Surface bunny = make_surface(std::make_shared<const RbfModel>(fit_rbf(cloud, {.max_samples = 900})));
  PathOptions options{
      .method = CorrectionMethod::flow, .march = MarchMethod::axis, .grid = GridMethod::grow, .cell = 0.5};
  PathSolver chain(bunny, options);
  PathSolver newton(bunny);
  // The third pair's chain ends in a neighbouring geodesic, 0.03 % longer than the shortest one.
  const Index ends[][2] = {{100, 900}, {700, 1200}, {300, 1500}};
  for (const auto& [from, to] : ends) {
    const PathResult flow = chain.solve(samples.col(from), samples.col(to));
    ASSERT_EQ(flow.status, Status::ok) << flow.message;
    EXPECT_EQ(flow.grid, GridMethod::grow);
    EXPECT_GT(flow.num_cells, 100);
    EXPECT_GT(flow.marched, flow.length) << "the march on bare cells is too long";
    ASSERT_TRUE(flow.flow);
    const PathResult exact = newton.solve(samples.col(from), samples.col(to));
    ASSERT_EQ(exact.status, Status::ok) << exact.message;
    EXPECT_LT(flow.length_error, 1e-3 * flow.length);
    EXPECT_LE(exact.length, flow.length + flow.length_error + exact.length_error);
    EXPECT_NEAR(flow.length, exact.length, 1e-3 * exact.length);
    const NewtonResult same_start = correct_newton(bunny, flow.grid_path);
    ASSERT_EQ(same_start.status, Status::ok) << same_start.reason;
    EXPECT_NEAR(flow.length, same_start.length, flow.length_error + same_start.length_error);
    // Not only as long: the same curve.
    double farthest = 0;
    for (Index j = 0; j < flow.points.cols(); ++j) {
      farthest = std::max(farthest, (same_start.points.colwise() - flow.points.col(j)).colwise().norm().minCoeff());
    }
    EXPECT_LT(farthest, 0.02 * exact.length);
  }
}

}  // namespace
}  // namespace taut
